//! Which files of a crate import which: each path counts for the file that defines what it names.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use super::paths::{Module, Use, code_of, module_of, uses_of, words_of};
use crate::layers::rust_files;

/// Which files import which.
pub(super) type Imports = BTreeMap<Module, BTreeSet<Module>>;

/// Re-exports of re-exports.
const DEPTH_MAX: usize = 10;

/// The files of a crate, by their modules.
#[derive(Default)]
pub(super) struct Files {
    code: BTreeMap<Module, String>,
    /// What names in scope stand for, which may be a module and a function as well; `None`:
    /// nothing of this crate.
    names: BTreeMap<Module, BTreeMap<String, Vec<Option<Module>>>>,
    /// Modules of which all names are in scope.
    globs: BTreeMap<Module, Vec<Module>>,
    /// What files need themselves.
    needs: BTreeMap<Module, Vec<Module>>,
}

impl Files {
    pub(super) fn new(code: BTreeMap<Module, String>) -> Self {
        let mut files = Self {
            code,
            ..Self::default()
        };
        let modules: Vec<Module> = files.code.keys().cloned().collect();
        let read: Vec<_> = modules.iter().map(|it| uses_of(&files.code[it])).collect();
        for (module, (uses, rest)) in modules.iter().zip(&read) {
            files.enter(module, uses, rest);
        }
        files
    }

    /// Takes what a file brings into its scope, and what it needs of that.
    fn enter(&mut self, module: &Module, uses: &[Use], rest: &str) {
        let (words, paths) = words_of(rest);
        let mut names: BTreeMap<String, Vec<Option<Module>>> = BTreeMap::new();
        let (mut globs, mut needs) = (Vec::new(), Vec::new());
        for Use {
            path,
            name,
            passed_on,
        } in uses
        {
            let target = self.absolute(module, path);
            if let Some(target) = target.clone() {
                if name == "*" {
                    globs.push(target[..target.len() - 1].to_vec());
                }
                // What is only passed on is not needed here, nor is a module by itself.
                let is_needed = if self.code.contains_key(&target) {
                    rest.contains(&format!("{name}("))
                } else {
                    !passed_on || words.contains(name.as_str())
                };
                if is_needed {
                    needs.push(target);
                }
            }
            names.entry(name.clone()).or_default().push(target);
        }
        for path in paths {
            match names.get(&path[0]) {
                Some(fronts) => {
                    let fronts = self.before_others(fronts).flatten();
                    needs.extend(fronts.map(|front| [front, &path[1..]].concat()));
                }
                None => needs.extend(self.absolute(module, &path)),
            }
        }
        self.names.insert(module.clone(), names);
        self.globs.insert(module.clone(), globs);
        self.needs.insert(module.clone(), needs);
    }

    /// A path in a file, from the crate on; `None` where it leads out of it.
    fn absolute(&self, module: &Module, path: &[String]) -> Option<Module> {
        let supers = path.iter().take_while(|part| *part == "super").count();
        let child = || [module, &path[..1]].concat();
        Some(match path[0].as_str() {
            "crate" => path[1..].to_vec(),
            "self" => [module, &path[1..]].concat(),
            "super" => {
                let front = &module[..module.len().saturating_sub(supers)];
                [front, &path[supers..]].concat()
            }
            _ if self.code.contains_key(&child()) => [module, path].concat(),
            _ => return None,
        })
    }

    /// Of what a name stands for all that more of a path may come after: where it is a module as
    /// well, not the function.
    fn before_others<'t>(
        &'t self,
        targets: &'t [Option<Module>],
    ) -> impl Iterator<Item = Option<&'t Module>> {
        let is_function = |target: &Module| {
            let name = target.last().map_or("", String::as_str);
            name.starts_with(char::is_lowercase) && !self.code.contains_key(target)
        };
        let leads_on = move |target: &&Option<Module>| {
            targets.len() == 1 || !target.as_ref().is_some_and(is_function)
        };
        targets.iter().filter(leads_on).map(Option::as_ref)
    }

    /// Adds the files that define what a path names; none for one that only names a module, or
    /// leads out of the crate.
    fn define(&self, path: &Module, depth: usize, found: &mut BTreeSet<Module>) {
        if depth > DEPTH_MAX {
            return;
        }
        let ends = (0..=path.len()).rev();
        let mut fronts = ends.map(|end| path.split_at(end));
        let Some((module, rest)) = fronts.find(|(front, _)| self.code.contains_key(*front)) else {
            return;
        };
        let Some((first, more)) = rest.split_first() else {
            return self.define_next_to(path, depth, found);
        };
        if let Some(targets) = self.names[module].get(first) {
            let all = targets.iter().map(Option::as_ref);
            let on = self.before_others(targets);
            let targets: Vec<_> = if more.is_empty() {
                all.collect()
            } else {
                on.collect()
            };
            for target in targets.into_iter().flatten() {
                self.define(&[target, more].concat(), depth + 1, found);
            }
            return;
        }
        let kinds = ["struct", "enum", "trait", "type", "fn", "const", "static"];
        let defines = |glob: &&Module| {
            let code = self.code.get(*glob);
            let heads = kinds.map(|kind| format!("{kind} {first}"));
            let has = |code: &String, head: &String| {
                let mut ends = code
                    .match_indices(head)
                    .map(|(at, _)| &code[at + head.len()..]);
                ends.any(|rest| {
                    !rest.starts_with(|sign: char| sign.is_alphanumeric() || sign == '_')
                })
            };
            code.is_some_and(|code| heads.iter().any(|head| has(code, head)))
        };
        let glob = self.globs[module].iter().find(defines);
        found.insert(glob.cloned().unwrap_or_else(|| module.to_vec()));
    }

    /// The same of a function with the name of a module: `plan::plan`, passed on next to it.
    fn define_next_to(&self, path: &Module, depth: usize, found: &mut BTreeSet<Module>) {
        let names = path.split_last();
        let targets = names.and_then(|(name, parent)| self.names.get(parent)?.get(name));
        for target in targets.into_iter().flatten().flatten() {
            if target != path {
                self.define(target, depth + 1, found);
            }
        }
    }

    pub(super) fn imports(&self) -> Imports {
        let targets = |(module, needs): (&Module, &Vec<Module>)| {
            let mut found = BTreeSet::new();
            for path in needs {
                self.define(path, 0, &mut found);
            }
            found.remove(module);
            (module.clone(), found)
        };
        self.needs.iter().map(targets).collect()
    }
}

/// Which files of a folder import which.
pub(super) fn imports_of(folder: &Path) -> Imports {
    let mut code: BTreeMap<Module, String> = BTreeMap::new();
    for file in rust_files(folder) {
        let text = code_of(&fs::read_to_string(&file).unwrap());
        let module = module_of(file.strip_prefix(folder).unwrap());
        // `lib.rs` and `main.rs` of one package count as one.
        code.entry(module).or_default().push_str(&text);
    }
    Files::new(code).imports()
}
