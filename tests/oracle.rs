//! A second implementation of motion and power, written from the physics alone:
//! slow, dense in time, with nothing of `plan` or `power` in it. It reads the
//! machine file itself and takes of a program its moves: geometry, kind and feed.

mod ahead;
mod axes;
mod compare;
mod course;
mod electrical;
mod judge;
mod machines;
mod over_time;
mod plant;
mod profile;
mod programs;
mod series;
mod spindle;
mod worked;

use crate::random::Random;
use compare::Compared;

/// Blocks of a program.
const BLOCKS: usize = 20;

/// Compares so many blocks of random programs on random machines.
fn compare(seed: u64, blocks: usize) {
    let mut all = Compared::default();
    let (mut shown, mut differing) = (Vec::new(), 0);
    while all.blocks < blocks {
        let seed = seed + all.blocks as u64;
        let mut random = Random::new(seed);
        let machine = machines::any(&mut random);
        let program = programs::any(&mut random, &machine, BLOCKS);
        all.program(&machine.toml, &program);
        if !all.wrong.is_empty() {
            differing += all.wrong.len();
            let wrong = std::mem::take(&mut all.wrong);
            println!("{seed}: {}", wrong.join("; "));
            if shown.len() < 4 {
                shown.push(format!("{}\n{program}\n{}", machine.toml, wrong.join("\n")));
            }
        }
    }
    assert!(
        shown.is_empty(),
        "{differing} differ:\n{}",
        shown.join("\n\n")
    );
    assert!(all.ratings > blocks / 100, "{} ratings", all.ratings);
}

#[test]
fn random_blocks_agree() {
    compare(1, 2000);
}

/// A tenth of 100,000 blocks, which takes some minutes.
macro_rules! tenths {
    ($($name:ident: $seed:expr),* $(,)?) => {
        /// `cargo test -- --ignored oracle::many`
        mod many {
            $(
                #[test]
                #[ignore = "10,000 blocks take some minutes"]
                fn $name() {
                    super::compare($seed, 10_000);
                }
            )*
        }
    };
}

tenths!(
    random_blocks_agree_0: 1_000_000,
    random_blocks_agree_1: 1_010_000,
    random_blocks_agree_2: 1_020_000,
    random_blocks_agree_3: 1_030_000,
    random_blocks_agree_4: 1_040_000,
    random_blocks_agree_5: 1_050_000,
    random_blocks_agree_6: 1_060_000,
    random_blocks_agree_7: 1_070_000,
    random_blocks_agree_8: 1_080_000,
    random_blocks_agree_9: 1_090_000,
);
