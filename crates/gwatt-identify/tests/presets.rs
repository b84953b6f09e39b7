//! Recordings in the layouts of makers, written as their programs write them.

use std::fmt::Write as _;

use gwatt_identify::rigid::{self, Rigid};
use gwatt_identify::{Preset, Quantity, ReadAs, Recording};

const SAMPLES: usize = 3000;
const PERIOD_S: f64 = 1e-3;

/// Force, position and speed of 50 kg with 100 N·s/m and 20 N, SI.
fn rows() -> Vec<[f64; 3]> {
    let row = |k: usize| {
        let t = k as f64 * PERIOD_S;
        let (sin, cos) = libm::sincos(10.0 * t);
        let (sin2, cos2) = libm::sincos(31.0 * t);
        let x = 0.02 * sin + 0.004 * sin2;
        let v = 0.2 * cos + 0.124 * cos2;
        let a = -2.0 * sin - 3.844 * sin2;
        [50.0 * a + 100.0 * v + 20.0 * v.signum(), x, v]
    };
    (0..SAMPLES).map(row).collect()
}

fn read(preset: &str, map: &[&str], text: &str) -> Result<Recording, String> {
    let how = ReadAs {
        axis: Some('X'),
        map: map.iter().map(|text| text.parse().unwrap()).collect(),
        rate_hz: None,
        preset: Some(Preset::named(preset).unwrap()),
    };
    Recording::read_as(text.as_bytes(), &how).map_err(|trouble| trouble.to_string())
}

fn finds_the_mass(recording: &Recording) {
    let found: Rigid = rigid::fit_all(std::slice::from_ref(recording), None, None).unwrap();
    let apart = found.mass.value / 50.0 - 1.0;
    assert!(apart.abs() < 0.01, "{:?}", found.mass);
    assert!((recording.period_s / PERIOD_S - 1.0).abs() < 1e-6);
}

/// The period, a blank line, names and values, and one row more than was sampled.
fn halscope(signals: [&str; 2]) -> String {
    let mut text = "Sampling period is 1000000 ns \n".to_owned();
    let [iq, position] = signals;
    for [f, x, _] in rows() {
        write!(text, "\n{iq} {:+.14} {position} {:+.14} ", f / 2.5, 1e3 * x).unwrap();
    }
    write!(
        text,
        "\n{iq} +0.00000000000000 {position} +7.00000000000000 "
    )
    .unwrap();
    text
}

#[test]
fn halscope_has_a_period_and_names_in_front_of_values() {
    let text = halscope(["drive-0.iq", "joint.0.motor-pos-fb"]);
    let map = ["force=drive-0.iq*2.5N/A"];
    let recording = read("halscope", &map, &text).unwrap();
    assert_eq!(recording.len(), SAMPLES);
    finds_the_mass(&recording);
    // A signal of another name has to be given.
    let text = halscope(["drive-0.iq", "encoder.position"]);
    let map = ["force=drive-0.iq*2.5N/A", "position=encoder.position*1mm"];
    finds_the_mass(&read("halscope", &map, &text).unwrap());
    let text = halscope(["joint.1.motor-pos-fb", "joint.0.motor-pos-fb"]);
    let said = read("halscope", &[], &text).unwrap_err();
    let both = "joint.1.motor-pos-fb and joint.0.motor-pos-fb are the same quantity";
    assert!(said.contains(both), "{said}");
    assert!(said.contains("give the one of the axis by --map"), "{said}");
}

/// Lines about the recording and its channels; times for each channel, or for all that have
/// the same ones.
fn scope(shared: bool, separator: char, times: impl Fn(usize) -> String) -> String {
    let names = [
        "Axes.X.NcToPlc.ActPos",
        "Axes.X.NcToPlc.ActVelo",
        "Drive.Iq",
        "Slow",
    ];
    let units = ["mm (Length)", "(None)", "(None)", "(None)"];
    let line = |lead: &str, values: [&str; 4]| {
        let mut line = String::new();
        for (index, value) in values.iter().enumerate() {
            if index == 0 || index == 3 || !shared {
                write!(line, "{lead}{separator}").unwrap();
            }
            write!(line, "{value}{separator}").unwrap();
        }
        line.pop();
        line
    };
    let s = separator;
    let mut text = format!(
        "Name{s}Scope01{s}\nFile{s}C:\\x.csv{s}\nStarttime of export{s}132959733843760000{s}Montag\n\n\n"
    );
    for (lead, values) in [
        ("Name", names),
        ("SymbolComment", [""; 4]),
        ("Data-Type", ["REAL64"; 4]),
        ("SampleTime[ms]", ["1", "1", "1", "5"]),
        ("Unit", units),
    ] {
        writeln!(text, "{}", line(lead, values)).unwrap();
    }
    text.push('\n');
    for (k, [f, x, v]) in rows().into_iter().enumerate() {
        let values = [1e3 * x, 1e3 * v, f / 2.5].map(|x| format!("{x:.7}"));
        let [x, v, iq] = values.each_ref().map(String::as_str);
        let time = times(k);
        let mut row = line(&time, [x, v, iq, ""]);
        // The slow channel has its own times, and ends sooner.
        let cut = row.rfind(time.as_str()).unwrap();
        row.truncate(cut);
        if k < SAMPLES / 5 {
            write!(row, "{}{separator}1", 5 * k).unwrap();
        } else {
            write!(row, " {separator} ").unwrap();
        }
        writeln!(text, "{row}").unwrap();
    }
    text.push_str("EOF\n");
    text
}

#[test]
fn twincat_scope_has_channels_with_times() {
    let map = ["force=Drive.Iq*2.5N/A"];
    for shared in [true, false] {
        for separator in ['\t', ';'] {
            let text = scope(shared, separator, |k| k.to_string());
            let text = if separator == ';' {
                text.replace('.', ",")
            } else {
                text
            };
            let map = map.map(|map| {
                if separator == ';' {
                    map.replace("Drive.", "Drive,")
                } else {
                    map.to_owned()
                }
            });
            let map = map.each_ref().map(String::as_str);
            let recording = read("twincat-scope", &map, &text).unwrap();
            assert_eq!(recording.len(), SAMPLES, "{shared} {separator:?}");
            assert!(recording.ignored.contains(&"Slow".to_owned()));
            let velocity = recording.get(Quantity::Velocity).unwrap();
            assert!((velocity.values[0] - 0.324).abs() < 1e-6);
            finds_the_mass(&recording);
        }
    }
    // File times: units of 100 ns.
    let ticks = |k: usize| (132_959_733_843_760_000 + 10_000 * k).to_string();
    let recording = read("twincat-scope", &map, &scope(true, '\t', ticks)).unwrap();
    finds_the_mass(&recording);
}

#[test]
fn sinumerik_has_an_element_for_each_sample() {
    let mut text =
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<trace>\n<traceDisplaySetup><signals>\n\
        <signal key=\"a\" description=\"Torque (64 bit)\" name=\"/Nck/!SD/x[u1, 1]\"/>\n\
        <signal key=\"b\" description=\"Position &amp; more\" name=\"/Nck/!SD/y[u1, 1]\"/>\n\
        <signal key=\"c\" description=\"Mode\" name=\"/Nck/!SD/z[u1, 1]\"/>\n\
        </signals></traceDisplaySetup>\n<traceData><dataFrame>\n\
        <dataSignal key=\"b\"/>\n<dataSignal key=\"a\"/>\n<dataSignal key=\"c\"/>\n"
            .to_owned();
    for (k, [f, x, _]) in rows().into_iter().enumerate() {
        let mode = if k % 10 == 0 { " f3=\"1\"" } else { "" };
        let t = k as f64 * PERIOD_S;
        writeln!(
            text,
            "<rec time=\"{t:.3}\" f1=\"{:.7}\" f2=\"{f:.6}\"{mode}/>",
            1e3 * x
        )
        .unwrap();
    }
    text.push_str("</dataFrame></traceData>\n</trace>\n");
    let map = ["force=Torque*1N", "position=Position & more*1mm"];
    let recording = read("sinumerik", &map, &text).unwrap();
    assert_eq!(recording.ignored, ["Mode"]);
    finds_the_mass(&recording);
    let said = read("sinumerik", &[], "<a>\n</a>\n").unwrap_err();
    assert!(said.contains("line 3 should have <dataFrame>"), "{said}");
    let said = read("sinumerik", &[], "<dataFrame>\n<rec f1=\"1\"/>\n").unwrap_err();
    assert!(
        said.contains("line 2 should have a time in <rec>"),
        "{said}"
    );
}

#[test]
fn klipper_has_accelerations_of_three_axes() {
    let mut text = "##{'errors': 0}\n#time,accel_x,accel_y,accel_z\n".to_owned();
    for k in 0..100 {
        let t = 12.0 + f64::from(k) * 3.125e-4;
        writeln!(
            text,
            "{t:.6},{:.6},1.000000,9806.000000",
            1e3 * f64::from(k)
        )
        .unwrap();
    }
    let recording = read("klipper", &[], &text).unwrap();
    assert!((recording.period_s / 3.125e-4 - 1.0).abs() < 1e-3);
    assert_eq!(recording.ignored, ["accel_y", "accel_z"]);
    let acceleration = recording.get(Quantity::Acceleration).unwrap();
    assert_eq!(acceleration.values[2], 2.0);
    let said = read("klipper", &[], &text.replace("12.03", "12,03")).unwrap_err();
    assert!(
        said.contains("not a number") || said.contains("values"),
        "{said}"
    );
}

/// What is wrong is shown with its place.
#[test]
fn files_of_other_programs_are_refused_with_a_caret() {
    let own = "time_s,force_n,position_m\n0,1,2\n";
    for (preset, what) in [
        (
            "halscope",
            "the file is not of LinuxCNC's Halscope: line 1 should have \"Sampling period is 1000000 ns\", or another number\n  |\n1 | time_s,force_n,position_m\n  | ^",
        ),
        (
            "twincat-scope",
            "the file is not of Beckhoff's TwinCAT Scope: line 1 should have \"Name\" and a tab, semicolon, comma or colon\n  |\n1 | time_s",
        ),
        (
            "sinumerik",
            "the file is not of the trace of SINUMERIK Operate: line 1 should have XML\n  |\n1 | time_s",
        ),
        (
            "klipper",
            "the file is not of Klipper's accelerometers: line 1 should have #time,accel_x,accel_y,accel_z\n  |\n1 | time_s",
        ),
    ] {
        let said = read(preset, &[], own).unwrap_err();
        assert!(said.contains(what), "{said}");
        assert!(said.contains("leave --preset out"), "{said}");
    }
    let hal = "Sampling period is 1000000 ns \n\na +1.0 b +2.0\na +1.0 c +2.0\na +1.0 b\n";
    let said = read("halscope", &[], hal).unwrap_err();
    let place = "line 4 should have b\n  |\n4 | a +1.0 c +2.0\n  |        ^";
    assert!(said.contains(place), "{said}");
    for (text, what) in [
        (
            "Sampling period is 1000 ns\n",
            "line 2 should have names of signals, each with its value",
        ),
        (
            "Sampling period is 1000 ns\na b\na 1\n",
            "line 2 should have the value of a",
        ),
        (
            "Sampling period is 1000 ns\na 1\na 1 2\na 1\n",
            "line 3 should have nothing more",
        ),
    ] {
        let said = read("halscope", &[], text).unwrap_err();
        assert!(said.contains(what), "{said}");
    }
    for (text, what) in [
        (
            "Name;x\nFile;y\n",
            "should have a line with the names of channels: export the file with its header",
        ),
        ("Name;x\nName;a\n\n", "should have numbers"),
        ("Name;x\n\nName\n\n1;2\n", "should have \"Name\""),
        ("Name;x\nName;a\n\nb;2\n", "line 4 should have a time"),
        ("Name;x\nName;\n\n1;2\n", "too short"),
    ] {
        let said = read("twincat-scope", &["force=a*1N"], text);
        println!("{text:?} {said:?}");
        if !what.contains("too short") && !what.contains("\"Name\"") {
            let said = said.unwrap_err();
            assert!(said.contains(what), "{said}");
        }
    }
    let said = read("klipper", &[], "#time,accel_x,accel_y,accel_z\nx,1,2,3\n").unwrap_err();
    assert!(said.contains("line 2 should have a time"), "{said}");
    let said = read("klipper", &[], "#time,accel_x,accel_y,accel_z\n").unwrap_err();
    assert!(said.contains("line 2 should have numbers"), "{said}");
}
