//! The page and the still picture of `report`, `check`, `limit` and `diff`.

mod browser;
mod compared;
mod outputs;
mod sets;
mod shown;
mod voltage;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;

use serde_json::Value;
use tempfile::TempDir;

use crate::shop::gwatt;

/// Scripts of the page: the data, two libraries, its own.
const SCRIPTS: usize = 4;

/// A folder, and gwatt run in it.
struct Desk(TempDir);

impl Desk {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn at(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn put(&self, name: &str, text: impl AsRef<[u8]>) {
        fs::write(self.at(name), text).unwrap();
    }

    fn get(&self, name: &str) -> String {
        fs::read_to_string(self.at(name)).unwrap()
    }

    fn run(&self, arguments: &[&str]) -> Output {
        gwatt(self.0.path(), arguments.iter().copied())
            .output()
            .unwrap()
    }

    /// Runs gwatt, which must exit with `code`.
    #[track_caller]
    fn exits(&self, code: i32, arguments: &[&str]) -> String {
        let output = self.run(arguments);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {said}");
        said
    }
}

/// A program of ours.
fn example(name: &str) -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    root.join("examples").join(name).display().to_string()
}

/// The data of a page.
fn data(page: &str) -> Value {
    let (_, rest) = page.split_once("id=\"data\">").unwrap();
    let (data, _) = rest.split_once("</script>").unwrap();
    serde_json::from_str(data).unwrap()
}

/// A list of figures, of which one may stand for all.
fn figures(column: &Value, count: usize) -> Vec<f64> {
    match column.as_array() {
        Some(list) => list.iter().map(|it| it.as_f64().unwrap()).collect(),
        None => vec![column.as_f64().unwrap(); count],
    }
}

fn most(bars: &Value, name: &str) -> f64 {
    let count = bars["count"].as_u64().unwrap() as usize;
    figures(&bars[name], count).into_iter().fold(0.0, f64::max)
}
