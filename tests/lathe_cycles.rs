//! G70 to G72 of LinuxCNC by cases worked by hand; `tests/conformance` holds
//! them against its interpreter.
//!
//! Source: LinuxCNC manual, "G70 Lathe finishing cycle", "G71 G72 Lathe roughing
//! cycles".

use insta::assert_snapshot;

use crate::listing::{listing, machine, refusals};

/// A shaft of 10 mm with a taper.
const CONTOUR: &str = "G18 G8 F100\no1 sub\nG0 X5 Z0\nG1 Z-4\nG1 X8 Z-7\no1 endsub\n";

fn moves(rest: &str) -> String {
    listing(&format!("{CONTOUR}{rest}\n"), &machine("linuxcnc"), None)
}

/// Levels at X9, X7 and X5; on X7 the taper is met at Z-6; away by 0.5 mm; at
/// last along the contour.
#[test]
fn roughing_cuts_level_by_level() {
    assert_snapshot!(moves("G71 Q1 X9 Z2 I2 R0.5"), @r"
7 rapid X9 Z2
7 rapid
7 rapid
7 feed Z-7 F100
7 rapid X9.5 Z-6.5
7 rapid Z1.5
7 rapid X9 Z2
7 rapid X7 Z1
7 feed Z-6 F100
7 rapid X7.5 Z-5.5
7 rapid Z0.5
7 rapid X7 Z1
7 rapid X5 Z0
7 feed Z-4 F100
7 feed X8 Z-7 F100
7 feed X9 F100
");
}

/// Next to the contour by (2 - 0) / 2 = 1 mm, then on it. The shifted lines meet
/// tan(22.5°) mm = 0.4142 mm before the corner.
#[test]
fn finishing_runs_beside_the_contour() {
    assert_snapshot!(moves("G70 Q1 X9 Z2 D2 P2"), @r"
7 rapid X9 Z2
7 rapid
7 rapid X6 Z0
7 feed Z-3.5858 F100
7 feed X8.7071 Z-6.2929 F100
7 rapid X9 Z2
7 rapid X5 Z0
7 feed Z-4 F100
7 feed X8 Z-7 F100
");
}

/// Under compensation the pass is shifted as any path: by a radius of 0.5 mm, and by the
/// tool's orientation by that in X and Z. The corner is met at Z-4 - 0.5 + 0.7071 - 0.5. How
/// `LinuxCNC` goes to the contour is not followed.
#[test]
fn finishing_under_compensation() {
    let found = moves("G0 X20 Z10\nG42.1 D1 L2\nG70 Q1 X9 Z2\nG40\nG0 X30 Z10");
    let feeds: Vec<&str> = found.lines().filter(|line| line.contains("feed")).collect();
    assert_eq!(
        feeds,
        ["9 feed Z-4.2929 F100", "9 feed X7.8536 Z-7.1464 F100"],
        "{found}"
    );
    let shop = crate::shop::Shop::mill("linuxcnc", "peak_power_w = 9000", "", "");
    let program = format!("{CONTOUR}G0 X20 Z10\nG42.1 D1 L2\nG70 Q1 X9 Z2\nG40\nG0 X30 Z10\nM2\n");
    shop.put("a.ngc", &program);
    let (code, _, errors) = shop.run("check a.ngc");
    assert_eq!(code, 0, "{errors}");
    assert!(
        errors.contains("the rapids of G70 count at full speed"),
        "{errors}"
    );
}

/// "It is an error if": what the manual lists, and what is not followed.
#[test]
fn what_cannot_be_is_refused() {
    let refused = |rest: &str| refusals(&format!("{CONTOUR}{rest}\n"), &machine("linuxcnc"));
    let cases = [
        "G71 X9 Z2",
        "G71 Q7 X9 Z2",
        "G17 G71 Q1 X9 Z2",
        "G71 Q1 X9 Z2 I0",
        "G70 Q1 X9 Z2 P0",
        "G1 G71 Q1 X9 Z2",
        "G93 G71 Q1 X9 Z2 F1",
        "G41.1 D1\nG71 Q1 X9 Z2",
        "G71 Q-1 X9 Z2",
        "o2 sub\nG0 X5 Z0\nG81 Z-2 R1\no2 endsub\nG71 Q2 X9 Z2",
        "o2 sub\nG0 X5 Z0\nG1 Z-4 A1 C1\no2 endsub\nG71 Q2 X9 Z2",
        "o2 sub\nG0 X5 Z0\no2 endsub\nG71 Q2 X9 Z2",
        "o2 sub\nG0 X5 Z0\nG1 Z-4\nG1 Z-5\nG1 X7\no2 endsub\nG71 Q2 X9 Z2 D1",
        "o2 sub\nG0 X5 Z0\nG1 Z-4\nG1 X8 Z-2\nG1 Z-9\no2 endsub\nG71 Q2 X9 Z2",
    ];
    let found: Vec<String> = cases.into_iter().map(refused).collect();
    assert_snapshot!(found.join("\n"), @r"
7 lathe-cycle: G70 to G72: without Q, the number of the contour's subroutine; inches are G20 here, millimetres G21
7 no-such-subprogram: there is no subprogram O7
7 lathe-cycle: G70 to G72: the cycle outside of G18
7 lathe-cycle: G70 to G72: the depth of cut I must be above 0, the retraction R not below it
7 lathe-cycle: G70 to G72: P is no number of passes
7 lathe-cycle: G70 to G72: another motion word next to the cycle
7 lathe-cycle: G70 to G72: the cycle under G93
8 compensation: a canned cycle under cutter compensation: the controller stops here
7 lathe-cycle: G70 to G72: Q is no number of a subroutine
9 lathe-cycle: the contour of a cycle with another cycle
9 lathe-cycle: A and C at one corner
10 lathe-cycle: G70 to G72: the contour of the cycle needs two moves at least
13 lathe-cycle: G70 to G72: two lines of the contour lie in one line, which the cycle cannot join
13 lathe-cycle: G70 to G72: the contour of the cycle goes back on itself
");
}
