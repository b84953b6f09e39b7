//! Finds the files that `builtin` embeds. They stand in `machine-configs` of the
//! workspace, for people to read and to copy. The link of that name in this
//! folder makes `cargo package` take them along; where links are not checked
//! out as such, as on Windows, it is a small file and the folder itself counts.

use std::env;
use std::path::PathBuf;

fn main() {
    let here = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").unwrap_or_default());
    let packed = here.join("machine-configs");
    let folder = if packed.is_dir() {
        packed
    } else {
        here.join("../../machine-configs")
    };
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=machine-configs");
    println!("cargo::rustc-env=MACHINE_CONFIGS={}", folder.display());
}
