//! `identify` and `excite`.

use super::Shop;

/// An axis of 50 kg that goes to and fro, as CSV.
pub(super) fn axis_recording() -> String {
    use std::fmt::Write as _;
    let mut text = "time_s,force_n,position_m\n".to_owned();
    for k in 0..2000 {
        let t = f64::from(k) * 1e-3;
        let (slow, fast) = (10.0, 31.0);
        let x = 0.02 * libm::sin(slow * t) + 0.004 * libm::sin(fast * t);
        let v = 0.02 * slow * libm::cos(slow * t) + 0.004 * fast * libm::cos(fast * t);
        let a =
            -0.02 * slow * slow * libm::sin(slow * t) - 0.004 * fast * fast * libm::sin(fast * t);
        let force = 50.0 * a + 100.0 * v + 20.0 * v.signum();
        writeln!(text, "{t:.3},{force},{x}").unwrap();
    }
    text
}

#[test]
fn what_is_identified_goes_into_json_and_into_the_machine_file() {
    let shop = Shop::new();
    shop.put("x.csv", axis_recording());
    let machine = shop.run(&["machine", "show", "vmc"]).stdout;
    shop.put("mill.toml", &machine);
    let ran = shop.run(&[
        "identify",
        "x.csv",
        "--axis",
        "x",
        "--json",
        "x.json",
        "--toml",
        "x.toml",
        "--into",
        "mill.toml",
    ]);
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    assert!(ran.stdout.contains("verdict: good"), "{}", ran.stdout);
    let json: serde_json::Value = serde_json::from_str(&shop.get("x.json")).unwrap();
    for (key, truth) in [
        ("mass_kg", 50.0),
        ("viscous_n_s_m", 100.0),
        ("coulomb_n", 20.0),
    ] {
        let value = json[key].as_f64().unwrap();
        assert!((value / truth - 1.0).abs() < 0.02, "{key} {value}");
        assert!(json[format!("{key}_std")].is_number());
    }
    for key in ["offset_n", "rel_error"] {
        assert!(json[key].is_number(), "{key}");
    }
    assert!(json["zeros"].as_array().unwrap().is_empty());
    assert_eq!(shop.get("mill.toml.bak"), machine);
    let merged = shop.get("mill.toml");
    assert_ne!(merged, machine);
    let comments = |text: &str| text.matches('#').count();
    assert_eq!(comments(&merged), comments(&machine));
    assert_eq!(shop.run(&["machine", "check", "mill.toml"]).code, 0);
    assert!(shop.get("x.toml").starts_with("[axes.X]\nmass_kg = "));
}

#[test]
fn what_cannot_be_identified_leaves_nothing_behind() {
    let shop = Shop::new();
    shop.put("x.csv", axis_recording().replace("force_n", "force"));
    shop.put("good.csv", axis_recording());
    let machine = shop.run(&["machine", "show", "vmc"]).stdout;
    shop.put("mill.toml", &machine);
    let before = shop.files();
    let run = |more: &[&'static str]| shop.run(&[&["identify"], more].concat());
    run(&["x.csv", "--axis", "X", "--json", "x.json"]).refused("unit of column force");
    run(&["none.csv", "--axis", "X"]).refused("cannot read the recording");
    run(&["good.csv", "--axis", "Q"]).refused("is no axis");
    run(&[
        "good.csv",
        "--axis",
        "B",
        "--into",
        "mill.toml",
        "--json",
        "x.json",
    ])
    .refused("no axis B");
    run(&["good.csv", "--axis", "X", "--json", "good.csv"]).refused("is read by this run");
    shop.run(&["power-fit", "good.csv"])
        .refused("no column velocity_mm_s");
    shop.run(&["excite", "--amplitude", "0"])
        .refused("not positive");
    shop.run(&["excite", "--amplitude", "1", "--order", "40"])
        .refused("from 3 to 20");
    shop.run(&[
        "excite",
        "--amplitude",
        "1",
        "--shape",
        "log-sweep",
        "--to-hz",
        "900",
    ])
    .refused("cannot be made");
    shop.run(&["excite", "--amplitude", "1", "--stroke-deg", "1"])
        .refused("--inertia-kg-m2");
    assert_eq!(shop.files(), before);
    assert_eq!(shop.get("mill.toml"), machine);
}

#[test]
fn an_excitation_warns_where_the_axis_would_leave_its_stroke() {
    let shop = Shop::new();
    let common = [
        "excite",
        "--amplitude",
        "50",
        "--name",
        "force_n",
        "--mass-kg",
        "90",
    ];
    let with = |more: &[&'static str]| shop.run(&[&common[..], more].concat());
    let ran = with(&["--stroke-mm", "1", "--speed-mm-min", "100"]);
    assert_eq!(ran.code, 0);
    assert!(ran.stderr.contains("would travel"), "{}", ran.stderr);
    assert!(ran.stderr.contains("would reach"), "{}", ran.stderr);
    assert_eq!(ran.stdout.lines().count(), 4096);
    let ran = with(&["--stroke-mm", "1000", "--speed-mm-min", "100000"]);
    assert!(!ran.stderr.contains("warning"), "{}", ran.stderr);
}

/// From a first recording, and from a machine file; what does not go together is refused.
#[test]
fn a_signal_is_designed_for_an_axis() {
    let shop = Shop::new();
    let machine = shop.run(&["machine", "show", "vmc"]).stdout;
    shop.put("mill.toml", &machine);
    let of_file = ["excite", "--machine", "mill.toml", "--axis", "X"];
    let with = |more: &[&'static str]| shop.run(&[&of_file[..], more].concat());
    let ran = with(&["--seconds", "2", "--stroke-mm", "20"]);
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    assert!(
        ran.stdout.starts_with("time_s,excitation_n\n0,"),
        "{}",
        ran.stdout
    );
    for word in [
        "expected standard errors, if the noise is a twentieth",
        "written  ",
        "nothing is known of its resonances",
    ] {
        assert!(ran.stderr.contains(word), "{word}: {}", ran.stderr);
    }
    with(&["--stroke-deg", "1"]).refused("--stroke-mm");
    with(&["--name", "torque-nm"]).refused("invalid value");
    with(&["--name", "torque_nm"]).refused("the axis slides");
    with(&["--name", "command_mm"]).refused("designed for forces and torques");
    with(&["--shape", "random"]).refused("cannot be used with");
    with(&["--seconds", "1e9"]).refused("choose another --seconds");
    shop.run(&["excite", "--machine", "mill.toml", "--axis", "B"])
        .refused("has no axis B");
    shop.run(&["excite", "--axis", "X", "--amplitude", "1"])
        .refused("no meaning without --for or --machine");
    shop.put("x.csv", axis_recording());
    shop.run(&["excite", "--for", "x.csv"])
        .refused("--amplitude");
    shop.run(&["excite", "--for", "none.csv", "--amplitude", "1"])
        .refused("cannot read the recording");
    shop.run(&[
        "excite",
        "--for",
        "x.csv",
        "--amplitude",
        "1",
        "-o",
        "x.csv",
    ])
    .refused("is read by this run");
}

/// A drive exports no times: the rate is that of the recording, and of the signal.
#[test]
fn a_signal_is_designed_for_a_recording_without_times() {
    use std::fmt::Write as _;
    let shop = Shop::new();
    let mut state = 1_u64;
    let mut random = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (state >> 33) as f64 / f64::from(1_u32 << 31) - 0.5
    };
    // 0.02 kg·m² under a torque of two levels.
    let names = "torque_nm,accel_rad_s2\n";
    let (mut timed, mut bare) = (format!("time_s,{names}"), names.to_owned());
    for k in 0..2000 {
        let torque = if random() > 0.0 { 1.0 } else { -1.0 };
        let row = format!("{torque},{:.6}", 50.0 * torque + random());
        writeln!(timed, "{:.3},{row}", f64::from(k) * 1e-3).unwrap();
        writeln!(bare, "{row}").unwrap();
    }
    shop.put("x.csv", timed);
    shop.put("bare.csv", bare);
    let design = |recording, more: &[&'static str]| {
        let common = ["excite", "--amplitude", "1", "--seconds", "1", "--for"];
        shop.run(&[&common[..], &[recording], more].concat())
    };
    design("bare.csv", &[]).refused("or give --rate-hz");
    design("bare.csv", &["--rate-hz=-1"]).refused("--rate-hz -1 is not positive");
    design("x.csv", &["--rate-hz", "1000"]).refused("--rate-hz has no meaning");
    let [timed, bare] = [
        design("x.csv", &[]),
        design("bare.csv", &["--rate-hz", "1000"]),
    ];
    assert_eq!(bare.code, 0, "{}", bare.stderr);
    assert_eq!(bare.stdout, timed.stdout);
}

/// Torque and angle of a motor whose screw of 10 mm moves 100 kg: what is written
/// is the mass of the slide.
#[test]
fn a_lead_converts_torque_and_angle() {
    use std::fmt::Write as _;
    let shop = Shop::new();
    // 50 kg at F in N and x in m: 100 kg at twice the force.
    let mut text = "time_s,torque_nm,position_deg\n".to_owned();
    let per_metre = std::f64::consts::TAU / 0.01;
    for row in axis_recording().lines().skip(1) {
        let cells: Vec<f64> = row.split(',').map(|cell| cell.parse().unwrap()).collect();
        let torque = 2.0 * cells[1] / per_metre;
        let angle = (cells[2] * per_metre).to_degrees();
        writeln!(text, "{:.3},{torque},{angle}", cells[0]).unwrap();
    }
    shop.put("x.csv", text);
    let machine = shop.run(&["machine", "show", "vmc"]).stdout;
    shop.put("mill.toml", &machine);
    let ran = shop.run(&[
        "identify",
        "x.csv",
        "--axis",
        "x",
        "--lead-mm",
        "10",
        "--json",
        "x.json",
        "--into",
        "mill.toml",
    ]);
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    let json: serde_json::Value = serde_json::from_str(&shop.get("x.json")).unwrap();
    let mass = json["mass_kg"].as_f64().unwrap();
    assert!((mass / 100.0 - 1.0).abs() < 0.02, "{mass}");
    let friction = json["coulomb_n"].as_f64().unwrap();
    assert!((friction / 40.0 - 1.0).abs() < 0.02, "{friction}");
    assert!(!shop.get("mill.toml").contains("mass_kg = 0."));
}

/// Torque of a motor with a slide in metres, or force of a slide with the motor's angle: a word
/// on the lever that is missing, and nothing for a machine file.
#[test]
fn force_and_motion_of_different_kinds_want_a_lead() {
    let shop = Shop::new();
    let machine = shop.run(&["machine", "show", "vmc"]).stdout;
    shop.put("mill.toml", &machine);
    for (names, said) in [
        ("torque_nm,position_m", "torque with a motion in metres"),
        ("force_n,position_rad", "force with a motion in radians"),
    ] {
        let recording = axis_recording();
        let (_, rows) = recording.split_once('\n').unwrap();
        shop.put("x.csv", format!("time_s,{names}\n{rows}"));
        let ran = shop.run(&["identify", "x.csv", "--axis", "x"]);
        assert_eq!(ran.code, 0, "{}", ran.stderr);
        let note = format!("{said}: figures are for a lever of 1 m; give --lead-mm");
        assert!(ran.stderr.contains(&note), "{}", ran.stderr);
        let asked = ["identify", "x.csv", "--axis", "x", "--into", "mill.toml"];
        shop.run(&asked)
            .refused(&format!("{said}: give --lead-mm, so that the machine file"));
        assert_eq!(shop.get("mill.toml"), machine);
    }
}

/// The data of the page that `identify --html` writes.
fn page(shop: &Shop, recording: &str, more: &[&str]) -> serde_json::Value {
    let recording = format!(
        "{}/examples/recordings/{recording}",
        env!("CARGO_MANIFEST_DIR")
    );
    let asked = [
        "identify", &recording, "--axis", "X", "--html", "x.html", "--json", "x.json",
    ];
    let ran = shop.run(&[&asked[..], more].concat());
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    let page = shop.get("x.html");
    assert!(!page.contains("/*"), "a mark is left");
    let (_, rest) = page.split_once("id=\"data\">").unwrap();
    let (data, _) = rest.split_once("</script>").unwrap();
    let data: serde_json::Value = serde_json::from_str(data).unwrap();
    assert_eq!(format!("{}\n", data["text"].as_str().unwrap()), ran.stdout);
    data
}

fn figures(list: &serde_json::Value) -> Vec<f64> {
    let list = list.as_array().unwrap().iter();
    list.map(|it| it.as_f64().unwrap_or(f64::NAN)).collect()
}

#[test]
fn the_page_of_a_flexible_axis_shows_its_response() {
    let shop = Shop::new();
    let data = page(&shop, "flexible-x.csv", &["--model", "flexible"]);
    let found: serde_json::Value = serde_json::from_str(&shop.get("x.json")).unwrap();
    assert_eq!(data["word"], found["verdict"]);
    let [hz, measured] = ["frequency_hz", "gain_db"].map(|key| figures(&data["response"][key]));
    let model = figures(&data["model"]["gain_db"]);
    assert_eq!([measured.len(), model.len()], [hz.len(); 2]);
    // Slow motion: 1/inertia. The anti-resonance is the model's smallest gain there.
    let slow_db = -20.0 * libm::log10(found["inertia_kg_m2"].as_f64().unwrap());
    assert!((model[0] - slow_db).abs() < 0.1, "{} {slow_db}", model[0]);
    let zero_hz = found["zeros"][0]["frequency_hz"].as_f64().unwrap();
    let below = hz.iter().position(|it| *it > 50.0).unwrap();
    let least = (0..below)
        .min_by(|a, b| model[*a].total_cmp(&model[*b]))
        .unwrap();
    assert!((hz[least] - zero_hz).abs() < 1.0, "{} {zero_hz}", hz[least]);
    let coherence = figures(&data["response"]["coherence"]);
    assert!(coherence.iter().all(|it| (0.0..=1.0 + 1e-9).contains(it)));
    assert!(data["trace"].is_null());
}

#[test]
fn the_page_of_a_rigid_axis_shows_force_over_time() {
    let shop = Shop::new();
    let data = page(&shop, "axis-x.csv", &[]);
    let found: serde_json::Value = serde_json::from_str(&shop.get("x.json")).unwrap();
    let trace = &data["trace"];
    let [force, modelled, left] = ["force", "modelled", "left"].map(|key| figures(&trace[key]));
    assert_eq!([modelled.len(), left.len()], [force.len(); 2]);
    assert_eq!(figures(&trace["time_s"]).len(), force.len());
    for (k, left) in left.iter().enumerate() {
        assert!(
            (force[k] - modelled[k] - left).abs() < 1e-6 * force[k].abs() + 1e-6,
            "{k}"
        );
    }
    // What is left by the force is the relative error, but for samples where the axis stands.
    let norm = |list: &[f64]| list.iter().map(|it| it * it).sum::<f64>().sqrt();
    let share = norm(&left) / norm(&force);
    let rel_error = found["rel_error"].as_f64().unwrap();
    assert!(
        share > 0.2 * rel_error && share < 5.0 * rel_error,
        "{share} {rel_error}"
    );
    // The model is the mass at all frequencies.
    let flat_db = -20.0 * libm::log10(found["mass_kg"].as_f64().unwrap());
    let model = figures(&data["model"]["gain_db"]);
    assert!(
        model.iter().all(|it| (it - flat_db).abs() < 1e-5),
        "{flat_db}"
    );
}
