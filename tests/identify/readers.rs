//! Reading of recordings and logs: whatever the bytes, a refusal says what to do.

use gwatt::identify::Recording;
use gwatt::identify::power_fit::PowerLog;
use proptest::prelude::*;

use super::csv;

fn recording(bytes: &[u8]) -> Result<(), String> {
    let read = Recording::read(bytes, Some('X'));
    read.map(|_| ()).map_err(|trouble| trouble.to_string())
}

fn log(bytes: &[u8]) -> Result<(), String> {
    let read = PowerLog::default().add(bytes, 'X');
    read.map_err(|trouble| trouble.to_string())
}

fn sound() -> String {
    let wave: Vec<f64> = (0..150).map(|k| libm::sin(f64::from(k))).collect();
    csv(&["torque_nm", "accel_rad_s2"], &[&wave, &wave])
}

#[test]
fn lines_are_named_and_nothing_of_the_readers_words() {
    let good = sound();
    let comments = good.replacen('\n', "\n# second line\n\n", 1);
    let with = |from: &str, to: &str| comments.replacen(from, to, 1).into_bytes();
    let mut latin = good.clone().into_bytes();
    let at = latin.iter().rposition(|byte| *byte == b'\n').unwrap();
    latin.splice(at.., *b"\n0.15,1,\xE9\n");
    for (bytes, message, help) in [
        (
            with("\n0.005000,", "\n0,005000,"),
            "line 9 has 4 values, more than the 3 names of the header",
            "decimal points",
        ),
        (
            with("\n0.005000,", "\n\"0,005000\","),
            "line 9: time_s is \"0,005000\", not a number",
            "decimal points instead of decimal commas",
        ),
        (
            with("\n0.005000,", "\n"),
            "line 9 has 2 values, fewer than the 3 names of the header",
            "cut the recording there",
        ),
        (
            with("\n0.005000,", "\ninf,"),
            "line 9: time_s is \"inf\"",
            "",
        ),
        (
            with("\n0.005000,", "\nNaN,"),
            "line 9: time_s is \"NaN\"",
            "",
        ),
        (with("\n0.005000,", "\n,"), "line 9: time_s is \"\"", ""),
        (
            with("\n0.005000,", "\n0.001000,"),
            "line 9: the time goes back",
            "sort",
        ),
        (
            with("\n0.005000,", "\n0.005200,"),
            "line 9 comes after",
            "fixed period",
        ),
        (
            latin,
            "line 152: accel_rad_s2 is \"é\", not a number",
            "cut",
        ),
        (b"\xFF\xFEt\0i\0".to_vec(), "the file is UTF-16", "UTF-8"),
        (
            b"\x7FELF\x02\0\0\0".to_vec(),
            "the file is not text",
            "export it as CSV",
        ),
        (
            b"time_s,torque_nm\n".to_vec(),
            "too short: 0 samples",
            "record",
        ),
    ] {
        let said = recording(&bytes).unwrap_err();
        assert!(said.contains(message), "{message}: {said}");
        assert!(said.contains("help: ") && said.contains(help), "{said}");
        assert!(!said.contains("CSV error"), "{said}");
    }
    // Whatever a program writes of the same.
    recording(format!("\u{feff}{}", good.replace('\n', "\r\n")).as_bytes()).unwrap();
    let quoted = good.replacen("time_s,torque_nm", "\"time_s\",\"torque_nm\"", 1);
    recording(format!("\u{feff}{quoted}").as_bytes()).unwrap();
}

#[test]
fn logs_are_refused_in_the_same_words() {
    let header = "velocity_mm_s,accel_mm_s2,power_w\n";
    for (text, message) in [
        (String::new(), "the recording is empty"),
        (header.replace(',', ";"), "no numbers below them"),
        (
            format!("{header}1,2,3\n1,\"2,5\",3\n"),
            "line 3: accel_mm_s2 is \"2,5\", not a number",
        ),
        (format!("{header}1,2\n"), "line 2 has 2 values"),
    ] {
        let said = log(text.as_bytes()).unwrap_err();
        assert!(said.contains(message), "{message}: {said}");
    }
    // A row without a value is passed over.
    log(format!("{header}1,,3\n1,nan,3\n").as_bytes()).unwrap();
}

proptest! {
    #[test]
    fn any_bytes_are_read_or_refused(bytes in proptest::collection::vec(any::<u8>(), 0..400)) {
        let _ = (recording(&bytes), log(&bytes));
    }

    #[test]
    fn a_recording_with_other_bytes_in_it_is_read_or_refused(
        at in 0_usize..3000,
        bytes in "[-0-9.,;\"\n\r#eE \u{feff}x]{0,12}",
        header in "(time_s|x_torque_nm|velocity_mm_s|accel_mm_s2|power_w|,|\"|_){0,8}",
    ) {
        let mut text = sound();
        let at = at.min(text.len());
        text.insert_str(at, &bytes);
        let other = format!("{header}\n{text}");
        for text in [text, other] {
            for said in [recording(text.as_bytes()), log(text.as_bytes())] {
                if let Err(said) = said {
                    prop_assert!(said.contains("help: "), "{}", said);
                }
            }
        }
    }
}
