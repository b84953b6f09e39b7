//! Where the results of a program go.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail, ensure};

use super::clash::refuse_clashes;
use super::input::{Program, is_dash};
use super::listing::Listing;
use super::page::Pictures;

/// Files, or for several programs the folders that hold a file for each.
#[derive(Debug, Clone, Default)]
pub struct Places {
    /// The written program.
    pub program: Option<PathBuf>,
    /// What each move draws, as CSV.
    pub csv: Option<PathBuf>,
    /// The same as JSON.
    pub json: Option<PathBuf>,
    /// The page.
    pub html: Option<PathBuf>,
    /// The still picture.
    pub svg: Option<PathBuf>,
}

impl Places {
    /// The pictures among them.
    pub fn pictures(&self) -> Pictures<'_> {
        Pictures {
            html: self.html.as_deref(),
            svg: self.svg.as_deref(),
        }
    }

    /// All of them.
    pub fn paths(&self) -> impl Iterator<Item = &Path> {
        let Self {
            program,
            csv,
            json,
            html,
            svg,
        } = self;
        let all = [program, csv, json, html, svg];
        all.into_iter().flatten().map(PathBuf::as_path)
    }

    /// The files of each program of a listing in these folders. None may be one that is
    /// read, or another one's.
    pub fn of_each(&self, listing: &Listing, machine: Option<&Path>) -> Result<Vec<Self>> {
        for folder in self.paths() {
            ensure!(
                !is_dash(folder) && (folder.is_dir() || !folder.exists()),
                "several programs go into a folder: {} is none",
                folder.display()
            );
        }
        let each: Vec<Self> = listing.places().map(|place| self.at(place)).collect();
        let programs = listing.programs();
        if self.paths().next().is_some() && programs.iter().any(|it| it.path().is_none()) {
            bail!("standard input has no name for a file in a folder: give it by itself");
        }
        let inputs: Vec<&Path> = programs
            .iter()
            .filter_map(Program::path)
            .chain(machine)
            .collect();
        let outputs: Vec<&Path> = each.iter().flat_map(Self::paths).collect();
        refuse_clashes(&inputs, &outputs)?;
        Ok(each)
    }

    /// The files of the program at that place in these folders.
    fn at(&self, place: &Path) -> Self {
        let in_folder = |folder: &Option<PathBuf>, ending: &str| {
            let mut name = folder.as_ref()?.join(place).into_os_string();
            name.push(ending);
            Some(PathBuf::from(name))
        };
        Self {
            program: in_folder(&self.program, ""),
            csv: in_folder(&self.csv, ".csv"),
            json: in_folder(&self.json, ".json"),
            html: in_folder(&self.html, ".html"),
            svg: in_folder(&self.svg, ".svg"),
        }
    }

    /// Makes the folders that they lie in.
    pub fn make_folders(&self) -> Result<()> {
        for folder in self.paths().filter_map(Path::parent) {
            fs::create_dir_all(folder)
                .with_context(|| format!("cannot make the folder {}", folder.display()))?;
        }
        Ok(())
    }
}
