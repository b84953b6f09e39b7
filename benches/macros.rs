//! Programs whose blocks are worked out, against the same moves written out:
//! moves and bytes a second through interpreter, planner and power.

use std::fmt::Write as _;
use std::io::Cursor;

use divan::Bencher;
use divan::counter::ItemsCount;
use gwatt::machine::Machine;
use gwatt::pipeline::{Options, analyze};

const ROWS: usize = 200;
const STEPS: usize = 100;

fn main() {
    divan::main();
}

fn machine(controller: &str) -> Machine {
    let mut text = format!(
        "schema = 1\nname = \"bench\"\ncontroller = \"{controller}\"\n[converter]\npeak_power_w = 1e9\n"
    );
    for axis in ["X", "Y", "Z"] {
        let _ = writeln!(
            text,
            "[axes.{axis}]\nrapid_mm_min = 12000\naccel_mm_s2 = 2000\nmass_kg = 100"
        );
    }
    match Machine::from_toml("bench.toml", &text) {
        Ok((machine, _)) => machine,
        Err(errors) => panic!("{controller}: {errors:?}"),
    }
}

fn run(bencher: Bencher<'_, '_>, controller: &str, program: &str) {
    let machine = machine(controller);
    bencher
        .counter(ItemsCount::new(ROWS * STEPS))
        .bench_local(|| analyze(Cursor::new(program), &machine, &Options::default(), None).is_ok());
}

#[divan::bench(args = ["linuxcnc", "fanuc"])]
fn flat(bencher: Bencher<'_, '_>, controller: &str) {
    let mut program = "G21 G90 F600.\n".to_owned();
    for row in 0..ROWS {
        for step in 0..STEPS {
            let x = step as f64 * 0.5;
            let y = row as f64 * 0.5 + 3.0 * libm::sin((step as f64 * 3.6).to_radians());
            let _ = writeln!(program, "G1 X{x:.4} Y{y:.4}");
        }
    }
    run(bencher, controller, &program);
}

#[divan::bench]
fn o_words(bencher: Bencher<'_, '_>) {
    let program = format!(
        "G21 G90 F600.\n#1=0\no1 while [#1 LT {ROWS}]\n#2=0\no2 while [#2 LT {STEPS}]\n\
         G1 X[#2*0.5] Y[#1*0.5+3*SIN[#2*3.6]]\n#2=[#2+1]\no2 endwhile\n#1=[#1+1]\no1 endwhile\nM2\n"
    );
    run(bencher, "linuxcnc", &program);
}

#[divan::bench]
fn custom_macro(bencher: Bencher<'_, '_>) {
    let program = format!(
        "G21 G90 F600.\n#1=0\nWHILE[#1LT{ROWS}]DO1\n#2=0\nWHILE[#2LT{STEPS}]DO2\n\
         G1 X[#2*0.5] Y[#1*0.5+3*SIN[#2*3.6]]\n#2=#2+1\nEND2\n#1=#1+1\nEND1\nM30\n"
    );
    run(bencher, "fanuc", &program);
}

#[divan::bench]
fn sinumerik(bencher: Bencher<'_, '_>) {
    let program = format!(
        "G71 G90 F600\nR1=0\nWHILE R1<{ROWS}\nR2=0\nWHILE R2<{STEPS}\n\
         G1 X=R2*0.5 Y=R1*0.5+3*SIN(R2*3.6)\nR2=R2+1\nENDWHILE\nR1=R1+1\nENDWHILE\nM30\n"
    );
    run(bencher, "siemens", &program);
}

#[divan::bench]
fn isg(bencher: Bencher<'_, '_>) {
    let program = format!(
        "%MAIN\nG90 F600\nP1=0\n$WHILE P1<{ROWS}\nP2=0\n$WHILE P2<{STEPS}\n\
         G1 X[P2*0.5] Y[P1*0.5+3*SIN[P2*3.6]]\nP2=P2+1\n$ENDWHILE\nP1=P1+1\n$ENDWHILE\nM30\n"
    );
    run(bencher, "isg", &program);
}

#[divan::bench]
fn osp(bencher: Bencher<'_, '_>) {
    let program = format!(
        "G90 F600\nVC1=0\nN1 VC2=0\nN2 G1 X=VC2*0.5 Y=VC1*0.5+3*SIN[VC2*3.6]\nVC2=VC2+1\n\
         IF [VC2 LT {STEPS}] N2\nVC1=VC1+1\nIF [VC1 LT {ROWS}] N1\nM2\n"
    );
    run(bencher, "okuma", &program);
}
