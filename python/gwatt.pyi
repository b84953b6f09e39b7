"""Power of CNC part programs, and programs that fit.

A program is its text (`str` or `bytes`), or a `pathlib.Path` to its file: its folder is then the
first where subprograms are looked for. Columns are `array.array`s of numbers, which NumPy, pandas
and Arrow take, and lists of texts; a number that is not known or does not apply is NaN.
"""

from array import array
from os import PathLike
from typing import Any, Literal, TypeAlias, TypedDict, final

from typing_extensions import Unpack

__all__ = [
    "Diagnostic",
    "DoesNotFit",
    "Error",
    "MachineError",
    "Refused",
    "Unsuitable",
    "Limited",
    "limit",
    "Machine",
    "machines",
    "Report",
    "check",
    "report",
    "series",
    "Summary",
    "__version__",
]

__version__: str

_Program: TypeAlias = str | bytes | bytearray | PathLike[str]
_Columns: TypeAlias = dict[str, array[int] | array[float] | list[str]]

class _Reading(TypedDict, total=False):
    """How a program is read and judged, as by the options of the commands."""

    start: dict[str, float] | Literal["unknown"]
    dialect: str
    tool_table: str | PathLike[str]
    parameters: str | PathLike[str]
    variables: dict[str, float]
    probe: Literal["hit", "miss", "both"]
    block_delete: bool | list[int]
    sub_paths: list[str | PathLike[str]]
    once: bool
    certificate: Literal["planned", "robust"]
    threads: int

@final
class Diagnostic:
    """What gwatt has to say about a line of a program or of a machine file."""

    @property
    def severity(self) -> Literal["error", "warning", "note"]: ...
    @property
    def rule(self) -> str:
        """Its stable name, which `gwatt explain` takes."""
    @property
    def message(self) -> str: ...
    @property
    def help(self) -> str | None: ...
    @property
    def file(self) -> str | None:
        """The file, where it is not the one that is being read."""
    @property
    def line(self) -> int:
        """The line from 1; 0 for the whole file."""
    @property
    def column(self) -> int: ...
    def render(self, name: str) -> str:
        """Draws it with the line under it and a caret; `name` is that of the file."""

class Error(Exception):
    """What keeps a call from its result."""

    diagnostics: list[Diagnostic]

class MachineError(Error):
    """The machine file is wrong."""

class Refused(Error):
    """The program is refused: it cannot be read with certainty."""

    more: int
    """Errors that are not listed."""

class DoesNotFit(Error):
    """No program that fits can be written with what is allowed."""

    summary: dict[str, Any]

class Unsuitable(Error):
    """What is asked for cannot be done with this machine."""

@final
class Machine:
    """A machine: its axes, what feeds them, and how its control reads programs."""

    def __new__(cls, name_or_path: str | PathLike[str]) -> Machine:
        """Loads the machine of that name that is built in, else a file."""
    @staticmethod
    def from_toml(text: str, path: str = "machine.toml") -> Machine:
        """Reads the text of a machine file; a profile that it names is looked for next to `path`."""
    @property
    def name(self) -> str: ...
    @property
    def axes(self) -> str:
        """The letters of its axes."""
    @property
    def controller(self) -> str:
        """How its control reads programs."""
    @property
    def peak_power_w(self) -> dict[str, float]:
        """Peak power of each converter by its name, without the margin."""
    @property
    def margin(self) -> float:
        """Share of the peak power that is kept free."""
    @property
    def warnings(self) -> list[Diagnostic]:
        """What is doubtful in its file."""

@final
class Summary:
    """The figures of a program."""

    @property
    def fits(self) -> bool:
        """Whether every move fits, and all limits over time are kept."""
    @property
    def duration_s(self) -> float: ...
    @property
    def peak_w(self) -> float:
        """Largest bus power."""
    @property
    def peak_line(self) -> int: ...
    @property
    def regen_w(self) -> float:
        """Largest power fed back."""
    @property
    def regen_line(self) -> int: ...
    @property
    def energy_j(self) -> float | None:
        """Energy drawn; None in `check`."""
    @property
    def lines(self) -> int: ...
    @property
    def moves(self) -> int: ...
    @property
    def unfit_count(self) -> int: ...
    @property
    def certificate(self) -> Literal["planned", "robust"] | None: ...
    @property
    def conditions(self) -> list[str]:
        """The conditions under which the figures hold."""
    @property
    def diagnostics(self) -> list[Diagnostic]:
        """Warnings and notes."""
    def to_dict(self) -> dict[str, Any]:
        """All of it, with the moves that do not fit and the limits over time."""

@final
class Report:
    """The figures of a program and of each of its moves."""

    @property
    def summary(self) -> Summary: ...
    @property
    def blocks(self) -> _Columns:
        """The columns of `gwatt report --csv`."""

@final
class Limited:
    """A program that fits, and what was done to it."""

    @property
    def program(self) -> bytes:
        """The program as it is to be run."""
    @property
    def before(self) -> Summary: ...
    @property
    def after(self) -> Summary: ...
    @property
    def edited_lines(self) -> int: ...
    @property
    def blocks(self) -> _Columns:
        """Each move before and after: the columns of `gwatt limit --report`."""
    def to_dict(self) -> dict[str, Any]:
        """All of it but the program and the moves."""

def machines() -> list[str]:
    """The names of the built-in machines, the default first."""

def check(program: _Program, machine: Machine, **reading: Unpack[_Reading]) -> Summary:
    """Reads a program and says what it draws. That it does not fit is no error."""

def report(program: _Program, machine: Machine, **reading: Unpack[_Reading]) -> Report:
    """Reads a program and gives the figures of each of its moves as columns."""

def series(
    program: _Program,
    machine: Machine,
    *,
    step_ms: float = 1.0,
    max_rows: int = 10_000_000,
    **reading: Unpack[_Reading],
) -> _Columns:
    """The planned motion, forces and powers over time: the columns of `report --series`."""

def limit(
    program: _Program,
    machine: Machine,
    *,
    allow: list[Literal["feed", "expand", "straighten", "stop", "pause", "unverified"]] = ...,
    strategy: Literal["preset", "speed", "accel", "optimal", "split"] = "optimal",
    **reading: Unpack[_Reading],
) -> Limited:
    """Writes a program that fits, or raises `DoesNotFit`."""
