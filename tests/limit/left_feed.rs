//! Lines that run under feeds that differ, and feeds that the program works out.
//!
//! At the end of its ramp an axis draws 100 W + 0.5 m/s·(200·3 + 100) N/0.8 = 537.5 W.

use crate::shop::Shop;

/// What is written, which fits.
fn limited(controller: &str, power_w: f64, program: &str) -> String {
    let (code, text, errors) = Shop::straight(controller, power_w).limit(program, "--allow feed");
    assert_eq!(code, 0, "{controller}: {errors}");
    text
}

fn refused(controller: &str, program: &str, reason: &str) {
    let (code, text, errors) = Shop::straight(controller, 300.0).limit(program, "--allow feed");
    assert_eq!((code, text.as_str()), (1, ""), "{program}");
    assert!(errors.contains(reason), "{program}: {errors}");
}

const DIFFER: &str = "it runs several times, under feeds or modes that differ";

/// The rapids of a macro that is called with one F after another: the next block that obeys F
/// has its own.
#[test]
fn rapids_before_blocks_with_their_own_feed() {
    let program = "#1=100\nWHILE [#1 LT 400] DO1\nG0 X1000. Y800.\nG1 Z-10. F#1\nG0 Z0.\n\
                   #1=#1+100\nEND1\nG1 X0. F500.\nM30\n";
    assert_eq!(
        limited("iso", 600.0, program),
        "#1=100\nWHILE [#1 LT 400] DO1\nG1 X1000. Y800. F26404\nG0\nG1 Z-10. F#1\nG0 Z0.\n\
         #1=#1+100\nEND1\nG1 X0. F500.\nM30\n"
    );
}

/// After the loop one F is in force again, which the next block counts on, and so does anyone who
/// looks at the end.
#[test]
fn what_counts_on_the_feed_gets_it() {
    for (after, written) in [
        ("G1 X0.\nM30\n", "G1 X0. F300\nM30\n"),
        ("M30\n", "F300\nM30\n"),
        ("G0 X0.\nG1 X5. F9.\nM30\n", "G0 X0.\nG1 X5. F9.\nM30\n"),
    ] {
        let head = "#1=100.\nWHILE [#1 LT 400] DO1\nG1 Z-10. F#1\n";
        let tail = "Z0.\n#1=#1+100\nEND1\n";
        let program = format!("{head}G0 X1000. Y800.\nX0.\nG0 {tail}{after}");
        assert_eq!(
            limited("iso", 600.0, &program),
            format!("{head}G1 X1000. Y800. F26404\nG0\nX0.\nG0 {tail}{written}")
        );
    }
}

/// A feed that differs from run to run is written as what it was worked out from, as long as
/// that has the same value.
#[test]
fn feeds_that_differ_are_worked_out_again() {
    for (controller, word, counter) in [
        ("iso", "F#1", "#2=#1"),
        ("linuxcnc", "F[#1+1]", "#2=[#1]"),
        ("iso", "F[#1*2]", "M98 P9"),
    ] {
        let (head, end) = match controller {
            "linuxcnc" => (
                "G61 G0 X0\n#1=100\no1 while [#1 LT 400]\n",
                "o1 endwhile\nM2\n",
            ),
            _ => (
                "#1=100\nWHILE [#1 LT 400] DO1\n",
                "END1\nM30\nO9\n#4=1\nM99\n",
            ),
        };
        let program = format!(
            "{head}G1 Z-10. {word}\n{counter}\nG0 X1000. Y800.\nG0 X0.\nG1 Z0.\n#1=[#1+100]\n{end}"
        );
        let written = limited(controller, 600.0, &program);
        assert!(written.contains(&format!("G1 Z0. {word}\n")), "{written}");
    }
    // A block that reads the F in force finds it.
    let read = "#1=100\nWHILE [#1 LT 400] DO1\nG1 Z-10. F#1\nG0 X1000. Y800.\n#2=#4109\nG1 Z0. F1\n\
                #1=#1+100\nEND1\nM30\n";
    assert!(limited("iso", 600.0, read).contains("\nF#1\n#2=#4109\n"));
}

/// The same in languages with expressions of their own.
#[test]
fn feeds_that_differ_are_worked_out_again_in_each_language() {
    for (controller, power_w, program, given) in [
        (
            "siemens",
            600.0,
            "DEF REAL RATE\nG60\nR1=100\nWHILE R1<400\nRATE=R1*2\nG1 Z-10 F=RATE DIV 1\nR2=R1\n\
             G0 X1000 Y800\nG0 X0\nG1 Z0\nR1=R1+100\nENDWHILE\nM30\n",
            "G1 Z0 F=RATE DIV 1",
        ),
        (
            "okuma",
            600.0,
            "V1=100\nN1 G1 Z-10. F=V1*2\nV2=V1\nG0 X1000. Y800.\nG0 X0.\nG1 Z0.\nV1=V1+100\n\
             IF [V1 LT 400] N1\nM30\n",
            "G1 Z0. F=V1*2",
        ),
        (
            "isg",
            300.0,
            "P1=10000\n$WHILE P1 < 30000\nG60 G1 X1000 FP1\nG60 Z-10\nG60 G1 X0 F800\nP1=P1+7000\n\
             $ENDWHILE\nM30\n",
            "G60 G1 X1000 FMIN[P1,13714.]\nG60 Z-10 FP1",
        ),
    ] {
        let shop = Shop::straight(controller, power_w);
        shop.put("a.nc", program);
        let (code, text, errors) = shop.run("limit a.nc --allow feed --strategy speed");
        assert_eq!(code, 0, "{controller}: {errors}");
        assert!(text.contains(&format!("\n{given}\n")), "{text}");
    }
}

/// Nothing can be written where the feeds differ that are counted on, and what they were worked
/// out from has another value by then.
#[test]
fn feeds_that_differ_cannot_be_put_back() {
    let set_anew = "#1=100\nWHILE [#1 LT 400] DO1\nG1 Z-10. F#1\nG0 X1000. Y800.\n#1=#1+100\n\
                    G1 Z0.\nEND1\nM30\n";
    refused("iso", set_anew, DIFFER);
    let by_hand = "#1=100\nG1 F100.\nWHILE [#1 LT 400] DO1\nG0 X1000. Y800.\nG1 Z0.\n#1=#1+100\n\
                   G1 F#1\nZ5.\nEND1\nM30\n";
    refused("iso", by_hand, DIFFER);
    let at_the_end = "#1=100\nWHILE [#1 LT 400] DO1\nG1 Z-10. F#1\n#1=#1+100\nG0 X1000. Y800.\n\
                      END1\n";
    refused("iso", at_the_end, DIFFER);
    // The block that counts on it changes what it is worked out from.
    let in_the_block = "G60\nR1=100\nWHILE R1<400\nG1 Z-10 F=R1\nG0 X1000 Y800\nR1=R1+100 G1 Z0\n\
                        ENDWHILE\nM30\n";
    refused("siemens", in_the_block, DIFFER);
    // The name stands for another variable there.
    let elsewhere = "DEF REAL RATE\nG60\nRATE=100\nWHILE RATE<400\nG1 Z-10 F=RATE\nDOWN\n\
                     RATE=RATE+100\nENDWHILE\nM30\n%_N_DOWN_SPF\nPROC DOWN\nDEF REAL RATE=7\n\
                     G0 X1000 Y800\nG1 Z0\nM17\n";
    refused("siemens", elsewhere, DIFFER);
}

/// At F20000 an axis draws 391.7 W; half of 591.7 W is the F that the program works out, or the
/// lower one.
#[test]
fn what_the_program_works_out_is_held_below_a_value() {
    for (controller, program, written) in [
        (
            "iso",
            "#1=20000.\nG1 X1000. F#1\nX0.\nM30\n",
            "#1=20000.\nG1 X1000. F[[#1+13714.-ABS[#1-13714.]]/2]\nX0.\nF20000\nM30\n",
        ),
        (
            "linuxcnc",
            "#1=10000\nG61 G1 X1000 F[#1*2]\nX0\nM2\n",
            "#1=10000\nG61 G1 X1000 F[[[#1*2]+13714.-ABS[[#1*2]-13714.]]/2]\nX0\nF20000\nM2\n",
        ),
        (
            "siemens",
            "R1=10000\nG60 G1 X1000 F=R1*2\nX0\nM30\n",
            "R1=10000\nG60 G1 X1000 F=MINVAL(R1*2,13714.)\nX0\nF20000\nM30\n",
        ),
    ] {
        assert_eq!(limited(controller, 300.0, program), written);
    }
    let isg = Shop::straight("isg", 300.0);
    isg.put("a.nc", "P1=20000\nG60 G1 X1000 F=P1\nX0\nM30\n");
    let (code, text, errors) = isg.run("limit a.nc --allow feed --strategy speed");
    assert_eq!(code, 0, "{errors}");
    assert!(
        text.contains("\nG60 G1 X1000 F=MIN[P1,13714.]\nX0\n"),
        "{text}"
    );
    // A Fanuc control nests no more than five brackets.
    let nested = "#1=20000.\nG1 X1000. F[[[#1]]]\nM30\n";
    refused("iso", nested, "its feed is worked out by the program");
}

/// In a loop the runs that are slow enough stay as they are.
#[test]
fn slower_runs_keep_their_feed() {
    let program = "G61\nG0 X0\n#1=5000\no1 while [#1 LT 21000]\nG1 X1000 F#1\nG1 X0 F[#1/2]\n\
                   #1=[#1+5000]\no1 endwhile\nM2\n";
    let written = limited("linuxcnc", 300.0, program);
    assert_eq!(
        written,
        program.replace("X1000 F#1", "X1000 F[[#1+13714.-ABS[#1-13714.]]/2]")
    );
    let shop = Shop::straight("linuxcnc", 300.0);
    shop.put("b.nc", &written);
    let (_, text, _) = shop.run("moves b.nc");
    for (feed, runs) in [(5000, 2), (10000, 2), (13714, 2), (2500, 1), (7500, 1)] {
        let shown = format!("\"feed_mm_min\":{feed},");
        assert_eq!(text.matches(&shown).count(), runs, "{feed}: {text}");
    }
}

/// A subprogram whose blocks count on the F of each call: they get the lowest of all calls, where
/// one of them has to be lowered in one call, and the blocks after the calls have their own. Both
/// axes draw 100 W and 0.2357 m/s·(200·2.12 + 100) N/0.8 each at F20000.
#[test]
fn blocks_of_a_subprogram_get_the_lowest_feed() {
    let sub = "O2000\nG1 X500. Y500.\nX0. Y0.\nM99\n";
    let main = "O1000\nG90 G61\nG0 X0. Y0.\nG1 F8000.\nM98 P2000\nG1 X-10.\nF20000.\nM98 P2000\n\
                G1 X-20.\nM30\n";
    let own = main
        .replace("X-10.", "X-10. F8000.")
        .replace("X-20.", "X-20. F20000.");
    let lowered = "O2000\nG1 X500. Y500. F8000.\nX0. Y0. F8000.\nM99\n";
    assert_eq!(
        limited("fanuc", 450.0, &format!("{main}{sub}")),
        format!("{own}{lowered}")
    );
    // Blocks with an F of their own need none.
    assert_eq!(
        limited("fanuc", 450.0, &format!("{own}{sub}")),
        format!("{own}{lowered}")
    );
    // What fits in all of them stays.
    let whole = format!("{main}{sub}");
    assert_eq!(limited("fanuc", 900.0, &whole), whole);
    // The second block fits in every call, and gets the lowest all the same.
    let short = sub.replace("X0. Y0.", "X490.");
    let text = limited("fanuc", 350.0, &format!("{main}{short}"));
    let both = "X500. Y500. F8000.\nX490. F8000.\n";
    assert!(text.contains(both), "{text}");
    // A rapid between them is none that could be lowered so.
    let rapid = sub.replace("X0. Y0.", "G0 X0. Y0.\nG1 X1.");
    refused("fanuc", &format!("{main}{rapid}"), DIFFER);
}
