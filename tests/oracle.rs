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
pub(crate) mod random;
mod series;
mod spindle;
mod worked;

use compare::Compared;
use random::Random;

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

/// A quarter of 100,000 blocks, which take some minutes.
macro_rules! quarters {
    ($($name:ident: $seed:expr),*) => {$(
        #[test]
        #[ignore = "25,000 blocks take some minutes"]
        fn $name() {
            compare($seed, 25_000);
        }
    )*};
}

quarters!(
    many_random_blocks_agree: 1_000_000,
    many_more_random_blocks_agree: 1_025_000,
    still_more_random_blocks_agree: 1_050_000,
    the_last_random_blocks_agree: 1_075_000
);
