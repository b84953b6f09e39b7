//! `verify`: a recording of the power over its prediction.

use std::fmt::Write as _;

use super::Shop;

/// Two axes that start together, rests and a feed.
const PROGRAM: &str = "G21 G90 G94 G17\nG0 X300 Y200\nG4 P0.4\nG1 F2000 X320\nG0 X0\nG4 P0.7\n\
                       G0 X250 Y250 Z-50\nG1 F500 Y260\nG0 X0 Y0 Z0\nM30\n";

/// What a meter records: the planned power from 12.5 s on, at 103 % of the time, 8 % more.
fn shop() -> Shop {
    let shop = Shop::new();
    shop.put("part.nc", PROGRAM);
    let machine = shop.run(&["machine", "show", "three-axis"]).stdout;
    shop.put(
        "mill.toml",
        machine.replace("margin = 0.1", "margin = 0.02"),
    );
    let points = planned(&shop, "three-axis", &[&["bus_w", "-regen_w"]]);
    let at = |t: f64| sampled(&points, t)[0];
    let mut log = "time_s,power_kw\n".to_owned();
    for k in 0..9000 {
        let t = f64::from(k) * 2e-3;
        writeln!(log, "{t:.3},{:.5}", 1.08e-3 * at((t - 12.5) / 1.03)).unwrap();
    }
    shop.put("log.csv", log);
    shop
}

/// The planned power of a machine over time: of each list of columns the sum.
fn planned(shop: &Shop, machine: &str, lists: &[&[&str]]) -> Vec<(f64, Vec<f64>)> {
    let series = ["report", "part.nc", "-m", machine, "--series", "s.csv"];
    let ran = shop.run(&[&series[..], &["--step-ms", "0.5"]].concat());
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    let series = shop.get("s.csv");
    let mut rows = series.lines();
    let names: Vec<&str> = rows.next().unwrap().split(',').collect();
    let place = |name: &str| names.iter().position(|it| *it == name).unwrap();
    let rows = rows.filter(|row| row.starts_with("before"));
    rows.map(|row| {
        let cells: Vec<f64> = row.split(',').map(|it| it.parse().unwrap_or(0.0)).collect();
        let value = |name: &&str| match name.strip_prefix('-') {
            Some(name) => -cells[place(name)],
            None => cells[place(name)],
        };
        let sums = lists.iter().map(|list| list.iter().map(value).sum());
        (cells[place("time_s")], sums.collect())
    })
    .collect()
}

/// What is planned at a time; nothing before and after the program.
fn sampled(points: &[(f64, Vec<f64>)], t: f64) -> Vec<f64> {
    let next = points.partition_point(|(other, _)| *other <= t);
    match (next.checked_sub(1).map(|k| &points[k]), points.get(next)) {
        (Some((a, before)), Some((b, after))) => {
            let pairs = before.iter().zip(after);
            pairs
                .map(|(w, v)| w + (v - w) * (t - a) / (b - a))
                .collect()
        }
        _ => vec![0.0; points[0].1.len()],
    }
}

const VERIFY: [&str; 5] = ["verify", "part.nc", "log.csv", "-m", "mill.toml"];

#[test]
fn shift_pace_and_margin_are_found() {
    let shop = shop();
    let written = ["--json", "v.json", "--csv", "v.csv", "--svg", "v.svg"];
    let page = ["--html", "v.html"];
    let ran = shop.run(&[&VERIFY[..], &written, &page].concat());
    // More than the margin of the file.
    assert_eq!(ran.code, 1, "{}", ran.stderr);
    assert!(ran.stdout.ends_with("verdict: good\n"), "{}", ran.stdout);
    let json: serde_json::Value = serde_json::from_str(&shop.get("v.json")).unwrap();
    let figure = |key: &str| json[key].as_f64().unwrap();
    assert!((figure("start_s") - 12.5).abs() < 2e-3, "{json}");
    assert!((figure("pace") - 1.03).abs() < 1e-3, "{json}");
    assert!((figure("gain") - 1.08).abs() < 5e-3, "{json}");
    assert!(
        (figure("margin") - (1.0 - 1.0 / 1.08)).abs() < 0.01,
        "{json}"
    );
    assert!(figure("correlation") > 0.999);
    // Every block that draws, by its line.
    let lines: Vec<u64> = json["blocks"]
        .as_array()
        .unwrap()
        .iter()
        .map(|it| it["line"].as_u64().unwrap())
        .collect();
    assert_eq!(lines, [2, 3, 4, 5, 6, 7, 8, 9]);
    assert!(
        shop.get("v.csv")
            .starts_with("line,runs,start_s,measured_w,predicted_w,measured_by_predicted\n2,1,12.")
    );
    let picture = shop.get("v.svg");
    assert!(
        picture.contains("Around line 9") || picture.contains("Around line 7"),
        "{picture}"
    );
    assert!(picture.ends_with("</svg>\n"));
    // The page holds the same text, picture and blocks.
    let page = shop.get("v.html");
    assert!(
        page.contains("<p class=\"good\">Verdict: good</p>"),
        "{page}"
    );
    assert!(page.contains(&picture), "{page}");
    assert_eq!(page.matches("<tr><th scope=\"row\">").count(), lines.len());
    assert!(
        page.ends_with("</html>\n") && !page.contains("<script"),
        "{page}"
    );
}

#[test]
fn the_margin_goes_into_the_machine_file() {
    let shop = shop();
    let before = shop.get("mill.toml");
    let into = [&VERIFY[..], &["--into", "mill.toml"]].concat();
    let ran = shop.run(&into);
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    assert_eq!(shop.get("mill.toml.bak"), before);
    let margin = shop.get("mill.toml");
    let margin = margin
        .lines()
        .find(|line| line.starts_with("margin"))
        .unwrap();
    let margin: f64 = margin
        .split(['=', '#'])
        .nth(1)
        .unwrap()
        .trim()
        .parse()
        .unwrap();
    assert!((margin - 0.074).abs() < 0.01, "{margin}");
    // With it the recording is covered, and there is nothing more to write.
    assert_eq!(shop.run(&VERIFY).code, 0);
    let again = shop.run(&into);
    assert_eq!(again.code, 0, "{}", again.stderr);
    let kept = "mill.toml is unchanged: its values already cover what was found";
    assert!(again.stderr.contains(kept), "{}", again.stderr);
    assert_eq!(shop.get("mill.toml.bak"), before);
}

#[test]
fn another_program_changes_no_machine_file() {
    let shop = shop();
    let before = shop.get("mill.toml");
    shop.put(
        "other.nc",
        "G21 G90 G94\nG0 X10\nG4 P3\nG0 Y400\nG4 P0.2\nG1 F9000 Z-400\nM30\n",
    );
    let other = [
        "verify",
        "other.nc",
        "log.csv",
        "-m",
        "mill.toml",
        "--into",
        "mill.toml",
    ];
    let ran = shop.run(&other);
    assert_eq!(ran.code, 1, "{}", ran.stdout);
    assert!(!ran.stdout.contains("verdict: good"), "{}", ran.stdout);
    assert!(
        ran.stderr.contains("mill.toml is as it was"),
        "{}",
        ran.stderr
    );
    assert_eq!(shop.get("mill.toml"), before);
}

#[test]
fn what_cannot_be_laid_over_is_refused() {
    let shop = shop();
    shop.put("empty.csv", "");
    shop.put("torque.csv", "time_s,torque_nm\n0,1\n1,2\n");
    shop.put("broken.nc", "G1 X\n");
    let verify = |program: &'static str, log: &'static str| {
        shop.run(&["verify", program, log, "-m", "mill.toml"])
    };
    verify("part.nc", "empty.csv").refused("empty.csv: the recording is empty");
    verify("part.nc", "torque.csv").refused("the log has no column of power");
    verify("part.nc", "missing.csv").refused("missing.csv: cannot read the log");
    verify("broken.nc", "log.csv").refused("broken.nc:1");
    shop.run(&[&VERIFY[..], &["--csv", "log.csv"]].concat())
        .refused("log.csv is read by this run");
    shop.run(&[&VERIFY[..], &["--map", "power=P*1kW"]].concat())
        .refused("there is no column P");
}

/// Drives that record their own powers; X moves 20 % more than its file says, at the same friction.
fn shop_by_axis() -> Shop {
    let shop = shop();
    let machine = shop.get("mill.toml");
    let heavy = machine.replace("inertia_kg_m2 = 0.0050", "inertia_kg_m2 = 0.0060");
    assert_ne!(heavy, machine);
    shop.put("heavy.toml", heavy);
    let columns = ["x_power_w", "y_power_w", "z_power_w"];
    let points = planned(
        &shop,
        "heavy.toml",
        &columns.each_ref().map(std::slice::from_ref),
    );
    let mut log = format!("time_s,{}\n", columns.join(","));
    for k in 0..9000 {
        let t = f64::from(k) * 2e-3;
        let [x, y, z] = sampled(&points, t - 7.0)[..] else {
            panic!("three axes");
        };
        writeln!(log, "{t:.3},{x:.3},{y:.3},{z:.3}").unwrap();
    }
    shop.put("log.csv", log);
    shop
}

/// By the powers of single axes it is X whose acceleration takes 1.2 times as much, and with that
/// no margin is needed.
#[test]
fn factors_of_axes_are_found_and_go_into_the_machine_file() {
    let shop = shop_by_axis();
    // Neither the margin nor the factors of the file cover it.
    assert_eq!(shop.run(&VERIFY).code, 1);
    let ran = shop.run(&[&VERIFY[..], &["--json", "v.json", "--into", "mill.toml"]].concat());
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    let line = ran.stdout.lines().find(|line| line.contains("axis X"));
    let line = line.expect("a line for X");
    assert!(
        line.contains("servo_factor_motor 1.2") && line.contains(" covers its 4 peaks: "),
        "{}",
        ran.stdout
    );
    let json: serde_json::Value = serde_json::from_str(&shop.get("v.json")).unwrap();
    let factors = json["axes"].as_array().unwrap().iter();
    let factors: Vec<f64> = factors
        .map(|it| it["servo_factor_motor"].as_f64().unwrap())
        .collect();
    assert!((factors[0] - 1.2).abs() < 0.015, "{json}");
    for other in &factors[1..] {
        assert!((other - 1.0).abs() < 0.015, "{json}");
    }
    let [alone, beyond] = ["margin", "margin_beyond_axes"].map(|key| json[key].as_f64().unwrap());
    assert!(alone > 0.05 && beyond < 0.01, "{json}");
    // The blocks are compared with what the file predicts.
    let blocks = json["blocks"].as_array().unwrap().iter();
    let worst = blocks.filter_map(|it| it["measured_by_predicted"].as_f64());
    assert!(worst.fold(0.0, f64::max) > 1.1, "{json}");
    let written = shop.get("mill.toml");
    let x = written.split("[axes.Y]").next().unwrap();
    assert!(x.contains("servo_factor_motor = 1.2"), "{written}");
    assert!(written.contains("margin = 0.02"), "{written}");
    // Once it is there, the recording is covered, and there is nothing more to write.
    assert_eq!(shop.run(&VERIFY).code, 0);
    let again = shop.run(&[&VERIFY[..], &["--into", "mill.toml"]].concat());
    assert!(
        again.stderr.contains("mill.toml is unchanged"),
        "{}",
        again.stderr
    );
    assert_eq!(shop.get("mill.toml"), written);
}

/// Loops of the axes in the machine file have a factor of their own: where it covers what was
/// found, nothing is written next to them, and where it does not, they have to go first.
#[test]
fn loops_are_not_contradicted_by_factors() {
    let shop = shop_by_axis();
    let before = shop.get("mill.toml");
    let with_loops = |loops: &str| {
        let feedforward = "velocity_feedforward = 1.0\nacceleration_feedforward = 0.0";
        let lines = before.lines().map(|line| match line {
            line if line.starts_with("max_speed_rpm") => {
                format!("{line}\n{loops}\n{feedforward}\n")
            }
            line => format!("{line}\n"),
        });
        let machine: String = lines.collect();
        shop.put("mill.toml", &machine);
        let ran = shop.run(&[&VERIFY[..], &["--into", "mill.toml"]].concat());
        assert_eq!(shop.get("mill.toml"), machine);
        ran
    };
    // These exceed the command by up to 45.4 %, those by 11.7 %.
    let ran = with_loops("position_gain_1_s = 100\nvelocity_bandwidth_hz = 30");
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    let ran = with_loops("position_gain_1_s = 30\nvelocity_bandwidth_hz = 60");
    assert_eq!(ran.code, 2, "{}", ran.stderr);
    let message = "the loops of axis X make a factor of 1.117, and its power shows 1.2";
    assert!(ran.stderr.contains(message), "{}", ran.stderr);
}

/// Where a move starts from a place that is not known, the prediction is a bound, and says so.
#[test]
fn an_unknown_start_is_noted() {
    let shop = shop();
    let known = ["verify", "part.nc", "log.csv", "-m", "mill.toml"];
    assert!(!shop.run(&known).stderr.contains("unknown start"));
    shop.put("part.nc", PROGRAM.replace("G1 F500 Y260", "G43 H1 Z20"));
    let ran = shop.run(&known);
    let expected = "gwatt: note: line 8 moves from an unknown start: the prediction is the most \
                    that it may draw there, and has no power of its axes; give --tool-table, \
                    --parameters or the offsets";
    assert!(ran.stderr.contains(expected), "{}", ran.stderr);
}
