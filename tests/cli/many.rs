//! Many programs: folders, patterns, lists, shares, and settings next to them.

use std::fs;

use super::{GENTLE, Ran, STEEP, Shop};

/// Programs in folders, and what is none.
fn shop() -> Shop {
    let shop = Shop::new();
    for folder in ["jobs/a", "jobs/b", "jobs/.git"] {
        fs::create_dir_all(shop.path().join(folder)).unwrap();
    }
    shop.put("jobs/a/one.nc", GENTLE);
    shop.put("jobs/a/two.NGC", STEEP);
    shop.put("jobs/b/O1234", GENTLE);
    shop.put("jobs/b/three.nc", STEEP);
    shop.put("jobs/.git/four.nc", STEEP);
    shop.put("jobs/notes.txt", "remember the milk\n");
    shop
}

/// The first words of the lines that name a program.
fn programs(ran: &Ran) -> Vec<&str> {
    let lines = ran.stdout.lines().filter(|line| {
        line.contains(".nc: ") || line.contains("O1234: ") || line.contains(".NGC: ")
    });
    lines.filter_map(|line| line.split(": ").next()).collect()
}

const ON: [&str; 2] = ["-m", "three-axis"];

#[test]
fn a_folder_stands_for_the_programs_below_it() {
    let shop = shop();
    let ran = shop.run(&[&["check", "jobs"], &ON[..]].concat());
    assert_eq!(ran.code, 1, "{}", ran.stderr);
    assert_eq!(
        programs(&ran),
        [
            "jobs/a/one.nc",
            "jobs/a/two.NGC",
            "jobs/b/O1234",
            "jobs/b/three.nc"
        ]
    );
    let totals = "4 programs: 2 fit, 2 do not, 0 are not read";
    assert_eq!(ran.stdout.lines().last(), Some(totals));
    let note = "jobs: 1 file is left out, no program by its name: jobs/notes.txt";
    assert!(ran.stderr.contains(note), "{}", ran.stderr);
    let quiet = shop.run(&[&["check", "jobs", "-q"], &ON[..]].concat());
    assert_eq!(programs(&quiet), ["jobs/a/two.NGC", "jobs/b/three.nc"]);
    assert_eq!(quiet.stdout.lines().last(), Some(totals));
    fs::create_dir(shop.path().join("empty")).unwrap();
    shop.run(&[&["check", "empty"], &ON[..]].concat())
        .refused("empty: no file below it is a program by its name");
}

#[test]
fn patterns_are_read_where_no_shell_has() {
    let shop = shop();
    let ran = shop.run(&[&["check", "jobs/**/t*.nc"], &ON[..]].concat());
    assert_eq!(programs(&ran), ["jobs/b/three.nc"]);
    shop.run(&[&["check", "jobs/*.mpf"], &ON[..]].concat())
        .refused("no file matches jobs/*.mpf");
    // A file of that name is that file.
    shop.put("[1].nc", GENTLE);
    assert_eq!(shop.run(&[&["check", "[1].nc"], &ON[..]].concat()).code, 0);
}

#[test]
fn names_come_from_lists() {
    let shop = shop();
    let check = |list: &str| {
        let arguments = [&["check", "--files-from", "-"], &ON[..]].concat();
        shop.run_with_input(&arguments, list)
    };
    let both = ["jobs/a/one.nc", "jobs/b/O1234"];
    assert_eq!(programs(&check("jobs/a/one.nc\r\n\njobs/b/O1234\n")), both);
    assert_eq!(programs(&check("jobs/a/one.nc\0jobs/b/O1234\0")), both);
    let none = check("");
    assert_eq!(none.code, 0);
    assert_eq!(none.stdout, "0 programs: 0 fit, 0 do not, 0 are not read\n");
    check("-\n").refused("standard input can be read only once");
    let arguments = [&["check", "--files-from", "nowhere"], &ON[..]].concat();
    shop.run(&arguments).refused("cannot read nowhere");
    // One that is missing does not keep the others from being checked.
    let ran = check("missing.nc\njobs/a/one.nc\n");
    assert_eq!(ran.code, 2);
    let totals = "2 programs: 1 fits, 0 do not, 1 is not read";
    assert_eq!(ran.stdout.lines().last(), Some(totals));
}

#[test]
fn shares_are_all_programs_each_once() {
    let shop = shop();
    let mut found: Vec<String> = Vec::new();
    for share in ["1/3", "2/3", "3/3"] {
        // Named twice, taken once.
        let arguments = ["check", "jobs", "jobs/a/one.nc", "--shard", share];
        let ran = shop.run(&[&arguments, &ON[..]].concat());
        found.extend(programs(&ran).into_iter().map(str::to_owned));
    }
    found.sort();
    assert_eq!(
        found,
        [
            "jobs/a/one.nc",
            "jobs/a/two.NGC",
            "jobs/b/O1234",
            "jobs/b/three.nc"
        ]
    );
    let empty = shop.run(&[&["check", "gentle.ngc", "--shard", "2/2"], &ON[..]].concat());
    assert_eq!((empty.code, programs(&empty).len()), (0, 0));
    shop.run(&[&["check", "jobs", "--shard", "4/3"], &ON[..]].concat())
        .refused("a share is such as 1/4");
}

#[test]
fn lines_of_json_come_one_a_program() {
    let shop = shop();
    let ran = shop.run(
        &[
            &["check", "jobs", "missing.nc", "--format", "jsonl"],
            &ON[..],
        ]
        .concat(),
    );
    assert_eq!(ran.code, 2);
    let lines: Vec<serde_json::Value> = ran
        .stdout
        .lines()
        .map(|line| serde_json::from_str(line).unwrap())
        .collect();
    assert_eq!(lines.len(), 5);
    assert!(lines.iter().all(|line| line["version"] == 1));
    assert_eq!(lines[0]["program"], "jobs/a/one.nc");
    assert_eq!(
        (&lines[0]["fits"], &lines[1]["fits"]),
        (&true.into(), &false.into())
    );
    assert_eq!(lines[1]["moves"], 2);
    // What `report` sums up over the moves.
    let report = ["report", "jobs/a/two.NGC", "--json", "two.json"];
    shop.run(&[&report, &ON[..]].concat());
    let report: serde_json::Value = serde_json::from_str(&shop.get("two.json")).unwrap();
    assert!(
        report["energy_j"]
            .as_f64()
            .is_some_and(|energy| energy > 0.0)
    );
    assert_eq!(lines[1]["energy_j"], report["energy_j"]);
    assert!(lines[4]["error"].as_str().is_some());
    assert_eq!(lines[4]["energy_j"], serde_json::Value::Null);
}

#[test]
fn each_is_limited_by_itself_into_a_folder() {
    let shop = shop();
    let limit = |more: &[&'static str]| {
        shop.run(&[&["limit", "jobs", "--allow", "feed"], more, &ON[..]].concat())
    };
    let ran = limit(&["-o", "fit", "--report", "rows", "-q"]);
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    assert!(
        ran.stderr
            .ends_with("4 programs: 4 fit, 0 do not, 0 are not read\n")
    );
    assert!(!ran.stderr.contains("fits now"), "{}", ran.stderr);
    // The same as one by one, and what fits comes as it was.
    let alone = [
        "limit",
        "jobs/a/two.NGC",
        "--allow",
        "feed",
        "-o",
        "alone.nc",
    ];
    shop.run(&[&alone, &ON[..]].concat());
    assert_eq!(shop.get("fit/a/two.NGC"), shop.get("alone.nc"));
    assert_eq!(shop.get("fit/b/O1234"), GENTLE);
    assert!(shop.get("rows/b/three.nc.csv").starts_with("line,"));
    let checked = shop.run(&[&["check", "fit"], &ON[..]].concat());
    assert_eq!(checked.code, 0, "{}", checked.stdout);
    // Into themselves.
    limit(&["-o", "jobs"]).refused("is read by this run");
    limit(&[]).refused("several programs: give a folder by -o, or --in-place");
    limit(&["-o", "gentle.ngc"]).refused("several programs go into a folder: gentle.ngc is none");
    // Two of one name.
    let two = [
        "limit",
        "jobs/a/one.nc",
        "gentle.ngc",
        "jobs/a/one.nc",
        "-o",
        "two",
    ];
    shop.run(&[&two, &ON[..]].concat())
        .refused("two/one.nc would be written twice");
    let ran = limit(&["--dry-run"]);
    assert!(
        ran.stdout.contains("--- a/jobs/a/two.NGC"),
        "{}",
        ran.stdout
    );
    let ran = limit(&["--in-place"]);
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    assert_eq!(shop.get("jobs/a/two.NGC.bak"), STEEP);
    assert_eq!(shop.get("jobs/a/two.NGC"), shop.get("alone.nc"));
    shop.run(&[&["limit", "-", "gentle.ngc", "-o", "x"], &ON[..]].concat())
        .refused("standard input has no name for a file in a folder");
}

/// Programs that cannot be made to fit, or are not read, do not keep others from being written.
#[test]
fn what_fits_is_written() {
    let shop = shop();
    shop.put("jobs/a/broken.nc", "G1 X\n");
    let ran = shop.run(&[&["limit", "jobs", "-o", "fit"], &ON[..]].concat());
    assert_eq!(ran.code, 2);
    let totals = "5 programs: 4 fit, 0 do not, 1 is not read\n";
    assert!(ran.stderr.ends_with(totals), "{}", ran.stderr);
    assert!(shop.path().join("fit/b/three.nc").exists());
    assert!(!shop.path().join("fit/a/broken.nc").exists());
}

#[test]
fn reports_of_many_go_into_a_folder() {
    let shop = shop();
    let ran = shop.run(&[&["report", "jobs", "-o", "rows", "--json", "rows"], &ON[..]].concat());
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    let alone = shop.run(&[&["report", "jobs/a/two.NGC"], &ON[..]].concat());
    assert_eq!(shop.get("rows/a/two.NGC.csv"), alone.stdout);
    assert!(
        shop.get("rows/b/O1234.json")
            .starts_with("{\"program\":\"jobs/b/O1234\"")
    );
    let fail = ["report", "jobs", "-o", "rows", "--fail"];
    assert_eq!(shop.run(&[&fail, &ON[..]].concat()).code, 1);
    shop.run(&[&["report", "jobs"], &ON[..]].concat())
        .refused("several programs: give a folder for their reports by -o");
    let series = ["report", "jobs", "--series", "s.csv"];
    shop.run(&[&series, &ON[..]].concat())
        .refused("--series shows one program");
}

#[test]
fn what_is_found_again_and_again_is_counted() {
    let shop = Shop::new();
    shop.put(
        "strange.nc",
        "G0 X1\n".to_owned() + &"G5.5 X2\n".repeat(40) + "M30\n",
    );
    let ran = shop.run(&[&["check", "strange.nc"], &ON[..]].concat());
    assert_eq!(ran.code, 2);
    let shown = ran.stderr.matches(" --> strange.nc:").count();
    assert_eq!(shown, 1, "{}", ran.stderr);
    assert!(
        ran.stderr
            .contains("strange.nc: and 39 more like it in lines 3-41: [unsupported-code] G5.5 is"),
        "{}",
        ran.stderr
    );
}

/// Only the first 50 errors are kept in full, with the first ones of further kinds.
#[test]
fn what_is_found_very_often_is_one_message() {
    let shop = Shop::new();
    let many = "G5.5 X2\n".repeat(500) + "G38.9 X2\nG5.5 X1\n" + &"G38.9 X2\n".repeat(3);
    shop.put("strange.nc", format!("G0 X1\n{many}M30\n"));
    let ran = shop.run(&[&["check", "strange.nc"], &ON[..]].concat());
    assert_eq!(ran.code, 2);
    let shown = ran.stderr.matches(" --> strange.nc:").count();
    assert_eq!(shown, 2, "{}", ran.stderr);
    for line in [
        "strange.nc: and 500 more like it in lines 3-51, and up to 503: [unsupported-code] G5.5 is",
        "strange.nc: and 3 more like it in lines up to 506: [",
    ] {
        assert!(ran.stderr.contains(line), "{}", ran.stderr);
    }
    assert!(!ran.stderr.contains("more errors"), "{}", ran.stderr);
}

#[test]
fn settings_lie_next_to_the_programs() {
    let shop = shop();
    let machine = shop.run(&["machine", "show", "three-axis"]).stdout;
    shop.put("jobs/mill.toml", machine);
    shop.put(
        "jobs/gwatt.toml",
        "machine = \"mill.toml\"\nallow = [\"feed\"]\n",
    );
    let ran = shop.run(&["check", "jobs/a", "-q"]);
    assert_eq!(ran.code, 1, "{}", ran.stderr);
    let note = "gwatt: note: settings are taken from jobs/gwatt.toml";
    assert!(ran.stderr.contains(note), "{}", ran.stderr);
    assert!(
        !ran.stderr.contains("no machine is given"),
        "{}",
        ran.stderr
    );
    let asked = shop.run(&[&["check", "jobs/a/two.NGC"], &ON[..]].concat());
    let found = shop.run(&["check", "jobs/a/two.NGC"]);
    assert_eq!(found.stdout, asked.stdout);
    // What `limit` may change, too.
    let alone = [
        "limit",
        "jobs/a/two.NGC",
        "--allow",
        "feed",
        "-o",
        "alone.nc",
    ];
    shop.run(&[&alone, &ON[..]].concat());
    let ran = shop.run(&["limit", "jobs/a/two.NGC", "-o", "set.nc"]);
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    assert_eq!(shop.get("set.nc"), shop.get("alone.nc"));
    // The command line goes before them.
    let other = shop.run(&["check", "jobs/a/two.NGC", "-m", "vmc"]);
    let plain = shop.run(&["check", "steep.ngc", "-m", "vmc"]);
    assert_eq!(
        other.stdout.replace("jobs/a/two.NGC", ""),
        plain.stdout.replace("steep.ngc", "")
    );
    // So does the environment.
    let mut command = shop.command(&["check", "jobs/a/two.NGC"]);
    let ran = Ran::from(command.env("GWATT_MACHINE", "vmc").output().unwrap());
    assert_eq!(ran.stdout, other.stdout);
    shop.run(&["check", "jobs/a/two.NGC", "gentle.ngc"])
        .refused(". has no gwatt.toml, jobs/a has settings in jobs/gwatt.toml");
    // They are those of schedules and contours too.
    shop.put("jobs/spindle.csv", "t_s,rpm\n0,1000\n");
    for command in ["spindle", "plan"] {
        let ran = shop.run(&[command, "jobs/spindle.csv"]);
        assert!(ran.stderr.contains(note), "{command}: {}", ran.stderr);
    }
    let ran = shop.run(&["contour", "jobs/a/two.NGC"]);
    assert!(ran.stderr.contains(note), "{}", ran.stderr);
    let text = "machine = \"mill.toml\"\nblock_delete = true\n";
    shop.put("jobs/gwatt.toml", text);
    let ran = shop.run(&["check", "jobs/a/two.NGC"]);
    assert_eq!(ran.code, 1, "{}", ran.stderr);
    for (text, message) in [
        ("machin = \"vmc\"\n", "unknown field `machin`"),
        ("allow = [\"all\"]\n", "unknown variant `all`"),
        (
            "start = \"Q1\"\n",
            "gwatt.toml: start = \"Q1\": Q1 is not an axis",
        ),
        ("machine = \"nowhere.toml\"\n", "jobs/nowhere.toml"),
    ] {
        shop.put("jobs/gwatt.toml", text);
        shop.run(&["check", "jobs/a/two.NGC"]).refused(message);
    }
}

/// The recipes for arrays of tasks: what these write together are all programs.
#[cfg(unix)]
fn all_tasks(command: &[&str], number: impl Fn(u32) -> Vec<(&'static str, String)>) {
    let shop = shop();
    let binary = std::path::Path::new(env!("CARGO_BIN_EXE_gwatt"));
    let path = format!("{}:/usr/bin:/bin", binary.parent().unwrap().display());
    for task in 1..=3 {
        let ran = std::process::Command::new("sh")
            .args(command)
            .current_dir(shop.path())
            .env("PATH", &path)
            .envs([
                ("MACHINE", "three-axis"),
                ("FOLDER", "jobs"),
                ("RESULTS", "results"),
            ])
            .envs(number(task))
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&ran.stderr);
        assert!(ran.status.success(), "{said}");
    }
    let results = ["1", "2", "3"].map(|task| shop.get(&format!("results/{task}.jsonl")));
    assert_eq!(results.concat().lines().count(), 4);
}

#[cfg(unix)]
#[test]
fn tasks_of_an_array_check_all_programs() {
    let recipe = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/fleet/slurm.sh");
    all_tasks(&[recipe], |task| {
        let count = ("SLURM_ARRAY_TASK_COUNT", "3".to_owned());
        vec![("SLURM_ARRAY_TASK_ID", task.to_string()), count]
    });
}

/// What the containers of an indexed job run, whose numbers begin with 0.
#[cfg(unix)]
#[test]
fn pods_of_an_indexed_job_check_all_programs() {
    let recipe = include_str!("../../examples/fleet/kubernetes.yaml");
    let (_, script) = recipe.split_once("            - |\n").unwrap();
    let script: Vec<&str> = script
        .lines()
        .map_while(|line| line.strip_prefix("              "))
        .collect();
    assert_eq!(script.len(), 4, "{script:?}");
    assert!(recipe.contains("command: [\"sh\", \"-euc\"]"));
    all_tasks(&["-euc", &script.join("\n")], |task| {
        let index = ("JOB_COMPLETION_INDEX", (task - 1).to_string());
        vec![index, ("SHARES", "3".to_owned())]
    });
}
