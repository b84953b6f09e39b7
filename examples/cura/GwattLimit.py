"""Cura post-processing script: has gwatt limit what was sliced.

Put it into the folder `scripts` of Cura's configuration (Help > Show Configuration Folder), start
Cura again, and add it under Extensions > Post Processing > Modify G-Code.

Cura saves a file as it was sliced where a script fails. So this one never fails: of a file that
does not fit, comments that say why are left, and nothing that moves.
"""

import json
import subprocess

from ..Script import Script


class GwattLimit(Script):
    """Runs `gwatt limit` over all layers at once."""

    def getSettingDataString(self):
        text = {"type": "str"}
        return json.dumps(
            {
                "name": "Limit the power (gwatt)",
                "key": "GwattLimit",
                "metadata": {},
                "version": 2,
                "settings": {
                    "program": {
                        **text,
                        "label": "gwatt",
                        "description": "Where the program gwatt lies.",
                        "default_value": "gwatt",
                    },
                    "machine": {
                        **text,
                        "label": "Machine file",
                        "description": "The whole path of the printer's machine file.",
                        "default_value": "",
                    },
                    "feeds": {
                        "label": "Lower feeds too",
                        "description": "Moves that extrude may become slower, not travels alone.",
                        "type": "bool",
                        "default_value": True,
                    },
                },
            }
        )

    def execute(self, data):
        program = self.getSettingValueByKey("program")
        machine = self.getSettingValueByKey("machine")
        command = [program, "limit", "-", "-m", machine, "--progress", "never"]
        if self.getSettingValueByKey("feeds"):
            command += ["--allow", "feed"]
        try:
            ran = subprocess.run(command, input="".join(data).encode(), capture_output=True)
            failed, said = ran.returncode != 0, ran.stderr.decode(errors="replace")
        except (OSError, ValueError) as error:
            failed, said = True, f"{program}: {error}"
        if failed:
            said = "gwatt has not limited this file, so it holds nothing to print:\n" + said
            return ["".join(f"; {line}\n" for line in said.splitlines())]
        return [ran.stdout.decode()]
