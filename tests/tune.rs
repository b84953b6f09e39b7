//! Response correction: filters, delays, files, and the page.

mod command;
mod commanded;
mod delays;
mod estimated;
mod page;
mod parameters;
mod refusals;

use std::f64::consts::{PI, TAU};
use std::fmt::Write as _;

use gwatt::identify::Factor;
use gwatt::identify::flexible::Method;
use gwatt::identify::tune::{
    AxisResponse, Biquad, Discretization, LowPass, Parameters, Tuned, Wish, design, excited,
    of_recording,
};
use gwatt::report::{tuned_json, tuned_text};

use crate::identify::{PERIOD_S, branched, choice, one_side, pair, recording, spring, table};

fn wish(discretization: Discretization) -> Wish {
    Wish {
        period_s: 1e-3,
        discretization,
        no_low_pass: false,
        order: None,
        bandwidth_hz: None,
    }
}

/// An axis as a file gives it: from force, rigid but for these zeros.
fn axis(letter: char, zeros: &[(f64, f64)]) -> AxisResponse {
    let mut text =
        format!("schema = 1\n[axes.{letter}]\ninput = \"force\"\nmass_kg = 100\nzeros = [\n");
    for (hz, damping) in zeros {
        let _ = writeln!(text, "{{ frequency_hz = {hz:?}, damping = {damping:?} }},");
    }
    text += "]\n";
    Parameters::read(&text).unwrap().axes.remove(0)
}

fn from_command(letter: char, poles: &[Factor], delay_s: f64) -> AxisResponse {
    AxisResponse {
        from_command: true,
        inertia: None,
        poles: poles.to_vec(),
        delay_s,
        ..axis(letter, &[])
    }
}

fn lag(time_constant_s: f64) -> Factor {
    Factor::Real { time_constant_s }
}

#[test]
fn filters_are_those_of_scipy() {
    // tests/tune/reference.py: X gets the zeros of the others.
    let zeros = [
        ('X', vec![]),
        ('Y', vec![pair(40.0, 0.03)]),
        ('Z', vec![pair(75.0, 0.02)]),
    ];
    let tustin = [
        (10.0, 0.918_286_750_816, -0.084_557_117_286),
        (40.0, 0.017_983_709_299, 0.039_504_386_570),
        (55.0, -0.339_908_816_836, 0.265_056_242_701),
        (180.0, -112.596_834_860_411, -55.290_441_581_764),
    ];
    let held = [
        (10.0, 0.901_062_169_670, -0.293_156_441_801),
        (40.0, 0.019_221_555_548, -0.407_567_112_574),
        (55.0, -0.147_476_991_508, -0.211_648_264_348),
        (180.0, -4.017_385_843_920, 74.192_604_303_241),
    ];
    for (kind, order, reference) in [
        (Discretization::Tustin, 4, tustin),
        (Discretization::Hold, 6, held),
    ] {
        let wish = Wish {
            bandwidth_hz: Some(200.0),
            ..wish(kind)
        };
        let correction = design(&zeros, &wish).unwrap();
        let low_pass = LowPass::Butterworth {
            order,
            bandwidth_hz: 200.0,
        };
        assert_eq!(correction.low_pass, low_pass);
        for (hz, re, im) in reference {
            let found = correction.at_hz(0, hz);
            let apart = (found.re - re).hypot_with(found.im - im);
            assert!(
                apart < 1e-9 * re.hypot_with(im).max(0.1),
                "{kind:?} {hz}: {found}"
            );
        }
        assert!(correction.filters[0].sections.iter().all(Biquad::is_stable));
    }
}

trait Hypot {
    fn hypot_with(self, other: f64) -> f64;
}

impl Hypot for f64 {
    fn hypot_with(self, other: f64) -> f64 {
        libm::hypot(self, other)
    }
}

fn tuned(axes: Vec<AxisResponse>, wish: Wish) -> Tuned {
    Tuned::new(axes, wish, 50.0).unwrap()
}

#[test]
fn filters_with_the_true_zeros_make_axes_alike() {
    let flexible = || axis('X', &[(40.0, 0.03)]);
    let cases: [Vec<AxisResponse>; 4] = [
        vec![flexible(), axis('Y', &[(31.0, 0.03)])],
        vec![flexible(), axis('Y', &[])],
        vec![
            axis('X', &[(40.0, 0.03), (75.0, 0.02)]),
            axis('Y', &[(31.0, 0.03)]),
        ],
        vec![flexible(), axis('Y', &[(31.0, 0.03)]), axis('Z', &[])],
    ];
    for axes in cases {
        let worst = |tuned: &Tuned, after: bool| {
            let each = tuned.pairs.iter().map(|pair| {
                let m = if after { pair.after } else { pair.before };
                (m.gain_db, m.phase_deg)
            });
            each.fold((0.0_f64, 0.0_f64), |a, b| (a.0.max(b.0), a.1.max(b.1)))
        };
        let matched = tuned(axes.clone(), wish(Discretization::Matched));
        let (before, after) = (worst(&matched, false), worst(&matched, true));
        assert!(before.0 > 20.0 && before.1 > 150.0, "{before:?}");
        assert!(after.0 < 0.005 && after.1 < 0.04, "{after:?}");
        // Tustin's rule bends frequencies, of a zero on one side alone by
        // ω²·T²/6 at 50 Hz: 0.14 dB.
        let bent = worst(&tuned(axes.clone(), wish(Discretization::Tustin)), true);
        assert!(bent.0 < 0.3 && bent.1 < 0.7, "{bent:?}");
        // Without a low-pass the same numerators, and no denominators.
        let bare = Wish {
            no_low_pass: true,
            ..wish(Discretization::Matched)
        };
        let bare = tuned(axes, bare);
        let after = worst(&bare, true);
        assert!(after.0 < 0.005 && after.1 < 0.04, "{after:?}");
        let sections = bare.correction.filters.iter().flat_map(|f| &f.sections);
        assert!(sections.clone().count() > 0);
        assert!(sections.into_iter().all(|section| section.a == [0.0, 0.0]));
    }
}

#[test]
fn filters_leave_rest_as_it_is_and_say_how_late_they_are() {
    let axes = vec![axis('X', &[(40.0, 0.03)]), axis('Y', &[(31.0, 0.03)])];
    let bare = Wish {
        no_low_pass: true,
        ..wish(Discretization::Matched)
    };
    // One pair of zeros: one period late.
    let correction = tuned(axes.clone(), bare).correction;
    assert!((correction.delay_s() - 1e-3).abs() < 3e-6);
    let correction = tuned(axes, wish(Discretization::Matched)).correction;
    let LowPass::Butterworth { bandwidth_hz, .. } = correction.low_pass else {
        panic!("a low-pass");
    };
    assert_eq!(bandwidth_hz, 120.0);
    // √2/ω by Tustin's rule, pre-warped: √2·T/(2·tan(ω·T/2)).
    let low_pass_s = std::f64::consts::SQRT_2 * 0.5e-3 / libm::tan(PI * 0.12);
    // Numerator and denominator are late by T both, and so their quotient not.
    assert!((correction.delay_s() - low_pass_s).abs() < 3e-6);
    for filter in &correction.filters {
        for section in &filter.sections {
            let [b0, b1, b2, a1, a2] = section.coefficients();
            assert!((b0 + b1 + b2 - (1.0 + a1 + a2)).abs() < 1e-12);
        }
    }
}

#[test]
fn a_pole_besides_a_zero_does_not_hide_the_judgement() {
    // Two resonances without a zero between them: a valley, but no dip.
    let chain = branched(0.006, 0.01, spring(0.004, 120.0, 0.03), &[]);
    let found = of_recording(&recording(&chain, 4.0, 0.05, 3), 'X', &choice(Method::Iv)).unwrap();
    assert!(
        found.zeros.is_empty() && found.notes.is_empty(),
        "{:?}",
        found.notes
    );
    let found = of_recording(
        &recording(&one_side(), 4.0, 0.05, 3),
        'X',
        &choice(Method::Iv),
    );
    let found = found.unwrap();
    assert_eq!(found.zeros.len(), 1);
    assert!((found.zeros[0].omega_rad_s.value / TAU - 40.0).abs() < 0.1);
}

/// Several zeros in a filter ask for no hundred times the force, however it becomes
/// digital; the axes are as alike as before.
#[test]
fn the_low_pass_keeps_the_gain_of_several_zeros_low() {
    let zeros = [('X', 25.0), ('Y', 44.0), ('Z', 70.0)];
    let axes = || -> Vec<AxisResponse> {
        let each = zeros
            .iter()
            .map(|(letter, hz)| axis(*letter, &[(*hz, 0.03)]));
        each.collect()
    };
    let kinds = [
        (Discretization::Matched, 0.01),
        (Discretization::Tustin, 0.2),
        (Discretization::Hold, 1.0),
    ];
    for (kind, apart_db) in kinds {
        let result = tuned(axes(), wish(kind));
        for index in 0..3 {
            let effort = result.correction.effort(index, 0.0);
            assert!(effort.gain <= 20.0, "{kind:?} {effort:?}");
            assert!(
                effort.accel >= 1.0 && effort.accel <= 20.0,
                "{kind:?} {effort:?}"
            );
        }
        for pair in &result.pairs {
            assert!(pair.after.gain_db < apart_db, "{kind:?} {pair:?}");
        }
        assert!(tuned_text(&result).contains("  Z: gain up to "));
    }
    // Asked for, a wide one is made, with its gain shown; a hold is refused there.
    let wide = |kind| Wish {
        bandwidth_hz: Some(210.0),
        ..wish(kind)
    };
    let result = tuned(axes(), wide(Discretization::Matched));
    let effort = result.correction.effort(2, 0.0);
    assert!(effort.gain > 1000.0, "{effort:?}");
    let (message, help) = refusal(Tuned::new(axes(), wide(Discretization::Hold), 50.0));
    assert!(message.contains("as zoh makes them"), "{message}");
    assert!(help.contains("lower --low-pass-hz"), "{help}");
}

fn refusal<T: std::fmt::Debug>(outcome: gwatt::identify::Outcome<T>) -> (String, String) {
    let trouble = outcome.unwrap_err();
    (trouble.message, trouble.help)
}

#[test]
fn too_little_motion_is_refused() {
    let position: Vec<f64> = (0..4000)
        .map(|k| 0.5 * libm::sin(TAU * 5.0 * f64::from(k) * PERIOD_S))
        .collect();
    let recording = table(&["torque_nm", "position_mm"], &[&position, &position]);
    // 0.5·(2π·5)² = 493.5 mm/s², by √2.
    let found = excited(&recording, 'X', Some(340.0)).unwrap();
    assert!(
        (found.rms - 348.9).abs() < 0.5 && found.unit == "mm/s²",
        "{found:?}"
    );
    let (message, help) = refusal(excited(&recording, 'X', Some(360.0)));
    assert!(
        message.starts_with("axis X: the excitation moves it by 348.9")
            && message.ends_with("mm/s² rms, less than the 360 that are asked for"),
        "{message}"
    );
    assert_eq!(
        help,
        "excite with more amplitude (gwatt excite --amplitude), and record again"
    );
}

#[test]
fn a_tuning_as_json_knows_what_is_not_known() {
    let mut out = Vec::new();
    let result = tuned(
        vec![axis('X', &[]), axis('Y', &[])],
        wish(Discretization::Matched),
    );
    tuned_json(&result, &mut out).unwrap();
    let json: serde_json::Value = serde_json::from_slice(&out).unwrap();
    assert_eq!(json["axes"][0]["rigid"], true);
    assert_eq!(json["axes"][0]["delay_s"], serde_json::Value::Null);
    assert_eq!(json["axes"][0]["sections"], serde_json::json!([]));
    assert_eq!(json["delays_agree"], serde_json::Value::Null);
    assert!(
        tuned_text(&result).contains("no axis has an anti-resonance: nothing is to be evened out")
    );
}

/// Its zeros would be those of others.
#[test]
fn one_axis_alone_has_nothing_to_be_matched_to() {
    let result = tuned(
        vec![axis('X', &[(40.0, 0.02)])],
        wish(Discretization::Matched),
    );
    let text = tuned_text(&result);
    assert!(
        text.contains("one axis alone has nothing to be matched to: give a recording of each axis"),
        "{text}"
    );
    assert!(!text.contains("no axis has"), "{text}");
}
