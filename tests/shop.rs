//! A folder with a machine, and gwatt run in it.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use tempfile::TempDir;

/// gwatt with these arguments, in a folder, without input.
pub fn gwatt<'a>(folder: &Path, arguments: impl IntoIterator<Item = &'a str>) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_gwatt"));
    command.args(arguments).current_dir(folder);
    command.stdin(Stdio::null());
    command
}

/// Exit code, standard output and standard error.
pub fn ended(output: Output) -> (i32, String, String) {
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (
        output.status.code().unwrap(),
        text(output.stdout),
        text(output.stderr),
    )
}

/// See the module.
pub struct Shop(pub TempDir);

impl Shop {
    /// A mill, `mill.toml`, without a margin that draws 100 W at rest.
    /// `converter` are further lines of its converter, `axis` of each axis;
    /// `rest` comes between them.
    pub fn mill(controller: &str, converter: &str, rest: &str, axis: &str) -> Self {
        let shop = Self(tempfile::tempdir().unwrap());
        let mut text = format!(
            "schema = 1\nname = \"mill\"\ncontroller = \"{controller}\"\n[converter]\n\
             base_load_w = 100\n{converter}\n[limits]\nmargin = 0\n{rest}\n"
        );
        for letter in ["X", "Y", "Z"] {
            let _ = write!(
                text,
                "[axes.{letter}]\nkind = \"linear\"\nrapid_mm_min = 30000\naccel_mm_s2 = 3000\n\
                 mass_kg = 200\ncoulomb_n = 100\nefficiency = 0.8\n{axis}\n"
            );
        }
        shop.put("mill.toml", &text);
        shop
    }

    /// A mill with linear rapids and this power.
    pub fn straight(controller: &str, power_w: f64) -> Self {
        let converter = format!("peak_power_w = {power_w}");
        Self::mill(controller, &converter, "[path]\nrapid = \"linear\"", "")
    }

    /// A lathe with linear rapids, `mill.toml` all the same, and offsets of four tools in
    /// `tools.tbl`. Its reference points and work offset are known.
    pub fn lathe(controller: &str, power_w: f64, rest: &str) -> Self {
        let shop = Self(tempfile::tempdir().unwrap());
        let mut text = format!(
            "schema = 1\nname = \"lathe\"\ncontroller = \"{controller}\"\n[converter]\n\
             peak_power_w = {power_w}\n[path]\nrapid = \"linear\"\n[limits]\nmargin = 0\n{rest}\n\
             [offsets]\nG54 = {{ X = 0, Z = -200 }}\n"
        );
        for letter in ["X", "Z"] {
            let _ = write!(
                text,
                "[axes.{letter}]\nkind = \"linear\"\nrapid_mm_min = 24000\naccel_mm_s2 = 5000\n\
                 mass_kg = 200\ncoulomb_n = 200\nreference_mm = 0\n"
            );
        }
        shop.put("mill.toml", &text);
        shop.put(
            "tools.tbl",
            "T1 P1 X-20 Z-30\nT2 P2 X-25 Z-10\nT3 P3\nT4 P4 D0.8 Q3\n",
        );
        shop
    }

    pub fn put(&self, name: &str, text: &str) {
        fs::write(self.0.path().join(name), text).unwrap();
    }

    pub fn get(&self, name: &str) -> String {
        fs::read_to_string(self.0.path().join(name)).unwrap()
    }

    pub fn has(&self, name: &str) -> bool {
        self.0.path().join(name).exists()
    }

    /// The same of `limit` with these options, where `a.nc` is this program.
    pub fn limit(&self, program: &str, options: &str) -> (i32, String, String) {
        self.put("a.nc", program);
        self.run(&format!("limit a.nc {options}"))
    }

    /// What `limit` writes for a program, which fits.
    #[track_caller]
    pub fn limited(&self, program: &str, options: &str) -> String {
        let (code, text, errors) = self.limit(program, options);
        assert_eq!(code, 0, "{errors}");
        self.put("out.nc", &text);
        let (code, _, errors) = self.run("check out.nc");
        assert_eq!(code, 0, "{errors}\n{text}");
        text
    }

    /// What `limit` writes into `out.nc`.
    #[track_caller]
    pub fn written(&self, program: &str, options: &str) -> String {
        let (code, _, errors) = self.limit(program, &format!("{options} -o out.nc"));
        assert_eq!(code, 0, "{errors}");
        self.get("out.nc")
    }

    /// Why `limit` writes nothing.
    #[track_caller]
    pub fn refused(&self, program: &str, options: &str) -> String {
        let (code, _, errors) = self.limit(program, &format!("{options} -o out.nc"));
        assert_eq!(code, 1, "{errors}");
        assert!(!self.has("out.nc"));
        errors
    }

    /// Exit code, standard output and standard error, on the mill.
    pub fn run(&self, arguments: &str) -> (i32, String, String) {
        let mut command = gwatt(self.0.path(), arguments.split_whitespace());
        ended(command.args(["-m", "mill.toml"]).output().unwrap())
    }
}
