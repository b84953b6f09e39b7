//! Random programs with levels of their own.

use std::fmt::Write as _;
use std::io::Cursor;

use super::super::Rig;
use super::{FANUC, HAAS, OVERRIDE, SINUMERIK};
use gwatt::machine::Machine;
use gwatt::pipeline::{Options, analyze, moves};
use proptest::prelude::*;

/// End points of all moves with a way.
fn ends(machine: &Machine, text: &[u8]) -> Vec<[f64; 2]> {
    let mut ends = Vec::new();
    moves(
        Cursor::new(text),
        machine,
        &Options::default(),
        &mut |mv, _| {
            if mv.length_mm > 0.0 {
                ends.push([mv.end[0], mv.end[1]]);
            }
            Ok(())
        },
    )
    .expect("a program");
    ends
}

/// A block of a random program: a rapid, X, Y, F, and a level that comes before it.
type Block = (bool, i16, i16, u16, Option<u8>);

fn text(blocks: &[Block], words: &[&str], mode: &str) -> String {
    let mut text = format!("{mode}\n");
    for (rapid, x, y, feed, level) in blocks {
        if let Some(word) = level.and_then(|level| words.get(usize::from(level))) {
            text.push_str(word);
            text.push('\n');
        }
        let motion = if *rapid { "G0" } else { "G1" };
        let _ = writeln!(text, "{motion} X{x}. Y{y}. F{}.", feed % 30_000 + 100);
    }
    text.push_str("M30\n");
    text
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// What is written fits at all overrides, goes the same way, and leaves the level of the
    /// program in force.
    #[test]
    fn random_programs_fit(
        blocks in prop::collection::vec(
            (any::<bool>(), -400..400_i16, -400..400_i16, any::<u16>(),
             prop::option::weighted(0.2, 0..4_u8)),
            1..12,
        ),
        exact in any::<bool>(),
        which in 0..4_usize,
        peak_w in 300.0..2500.0_f64,
        axis in prop::sample::select(vec![
            "", "coulomb_n = 100\nviscous_n_s_m = 200", "copper_w_n2 = 0.0001\nviscous_n_s_m = 50",
        ]),
    ) {
        let between = "between_moves = true\nlevel =";
        let rest = [
            HAAS.rest.replace("mode = \"exact-stop\"\n", "").replace("level =", between),
            SINUMERIK.rest.replace("[path]\nmode = \"exact-stop\"\n", "").replace("level =", between),
            OVERRIDE.rest.to_owned(),
            FANUC.rest.replace("mode = \"exact-stop\"\n", "")
                .replace("level =", "verified = true\nlevel ="),
        ];
        let rigs = [HAAS, SINUMERIK, OVERRIDE, FANUC];
        let words: [&[&str]; 4] = [
            &["G187 P1", "G187 P2", "G187 P3 E0.1", "G187"],
            &["DYNNORM", "DYNROUGH", "DYNSEMIFIN", "DYNFINISH"],
            &["M131", "M132", "M133"],
            &["G5.1 Q0", "G05.1 Q1 R1", "G5.1 Q1 R10"],
        ];
        let rig = Rig {
            peak_w,
            axis,
            rest: Box::leak(rest[which].clone().into_boxed_str()),
            ..rigs[which]
        };
        let stops = if which == 1 { "G60" } else { "G61" };
        let text = text(&blocks, words[which], if exact { stops } else { "G64" });
        let machine = rig.machine();
        let (written, summary) = rig.limit(text.as_bytes()).expect("a program");
        if summary.certified {
            let found = analyze(Cursor::new(&written), &machine, &Options::default(), None)
                .expect("the written program");
            prop_assert!(found.fits(), "{text}\n{}", String::from_utf8_lossy(&written));
            prop_assert_eq!(ends(&machine, text.as_bytes()), ends(&machine, &written));
            let last = |text: &[u8]| {
                let text = String::from_utf8_lossy(text).into_owned();
                text.lines().rev().find(|line| {
                    words[which].iter().any(|word| line == word)
                }).map(str::to_owned)
            };
            if let Some(own) = last(text.as_bytes()) {
                let means = |word: &str| match word {
                    "G187" => "G187 P2".to_owned(),
                    "G05.1 Q1 R1" => "G5.1 Q1 R1".to_owned(),
                    "G187 P3 E0.1" => "G187 P3".to_owned(),
                    other => other.to_owned(),
                };
                let text = String::from_utf8_lossy(&written).into_owned();
                let levels = ["G187", "DYN", "M13", "G5.1", "G05.1"];
                let kept = text.lines().rev().find(|line| {
                    levels.iter().any(|level| line.starts_with(level))
                }).map(means);
                prop_assert_eq!(kept, Some(means(&own)));
            }
        } else {
            // Friction alone, or rapids that no word lowers.
            prop_assert!(!summary.reasons.is_empty());
            // What fits by F alone fits with levels too.
            let (without, _) = rest[which].split_once("[[levels]]").unwrap_or_default();
            let plain = Rig { rest: Box::leak(without.to_owned().into_boxed_str()), ..rig };
            let selects = blocks.iter().any(|block| block.4.is_some());
            if !selects {
                let (_, plain) = plain.limit(text.as_bytes()).expect("a program");
                prop_assert!(!plain.certified, "{text}");
            }
        }
    }
}
