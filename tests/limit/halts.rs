//! `--allow stop`: exact stops between feeds where only the robust bound holds between
//! them, and where one costs less time than the lower feed.

use proptest::prelude::*;

use crate::shop::Shop;

/// At F20000 an axis draws 0.3333·(200·3 + 100)/0.8 = 292 W, and 100 W at rest: by itself
/// it fits under 450 W. Blended with the next one it draws 683 W, so that 350 W are shared
/// by both at F12000: 5 s against 3 s and 0.22 s for the stop.
#[test]
fn a_stop_takes_the_place_of_a_lower_feed() {
    let program = "G21 G90 G64\nG1 X1000. F20000.\nN20 Y1000.\nX0. Y0.\nM30\n";
    let (code, text, errors) = Shop::straight("fanuc", 450.0).limit(program, "--allow feed,stop");
    assert_eq!(code, 0, "{errors}");
    // X and Y together have 350 W, 0.2 m/s each: 0.2·2·(200·3 + 100)/0.8.
    assert_eq!(
        text,
        "G21 G90 G64\nG9 G1 X1000. F20000.\nN20 G9 Y1000.\nX0. Y0. F16970.\nF20000.\nM30\n"
    );
    let (code, text, _) = Shop::straight("fanuc", 450.0).limit(program, "--allow feed");
    assert_eq!(code, 0);
    assert!(text.contains("G1 X1000. F11999.\n"), "{text}");
}

/// 10 mm are gone in 0.05 s at F12000: a stop would cost 0.22 s.
#[test]
fn short_blocks_take_the_lower_feed() {
    let program = "G21 G90 G64\nG1 X10. F20000.\nY10.\nX0.\nY0.\nM30\n";
    let with = Shop::straight("fanuc", 450.0).limit(program, "--allow feed,stop");
    assert_eq!(with.0, 0, "{}", with.2);
    assert_eq!(
        with,
        Shop::straight("fanuc", 450.0).limit(program, "--allow feed")
    );
}

/// SINUMERIK: a rapid that runs by itself stands at both ends, and so does the feed in its
/// place, by G9: nothing blends it with what the control may have before it.
#[test]
fn a_rapid_by_itself_stays_so() {
    for program in [
        "G90 G71\nG0 X100 Y50\nM30\n",
        "G90 G71 G64\nT1 D1\nG0 X100 Y50\n",
    ] {
        let (code, text, errors) = Shop::straight("siemens", 600.0).limit(program, "");
        assert_eq!(code, 0, "{errors}");
        assert!(text.contains("\nG9 G1 X100 Y50 F"), "{text}");
    }
    // Where the next rapid follows it goes on into that, as before.
    let two = "G90 G71\nG0 X100 Y50\nG0 Z50\nM30\n";
    let (code, text, errors) = Shop::straight("siemens", 600.0).limit(two, "");
    assert_eq!(code, 0, "{errors}");
    assert!(!text.contains("G9 "), "{text}");
}

/// Without a word for the feed the stop alone may do.
#[test]
fn stops_need_no_other_permission() {
    let program = "G21 G90 G64\nG1 X10. F20000.\nY10.\nM30\n";
    let shop = Shop::straight("fanuc", 450.0);
    let (code, text, errors) = shop.limit(program, "--allow stop --report r.csv");
    assert_eq!(code, 0, "{errors}");
    assert_eq!(text, "G21 G90 G64\nG9 G1 X10. F20000.\nY10.\nM30\n");
    let report = shop.get("r.csv");
    let row = report.lines().nth(1).unwrap_or_default();
    assert!(row.contains(",exact stop,G9,"), "{report}");
    let (code, _, errors) = shop.limit(program, "");
    assert_eq!(code, 1);
    assert!(errors.contains("cutting feeds are not changed"), "{errors}");
}

#[test]
fn each_control_has_its_own_word() {
    for (controller, word) in [
        ("haas", "G9"),
        ("mazak", "G9"),
        ("mitsubishi", "G9"),
        ("syntec", "G9"),
        ("okuma", "G9"),
        ("siemens", "G9"),
        ("isg", "G60"),
    ] {
        let shop = Shop::straight(controller, 450.0);
        let program = "G90\nG1 X1000. F20000.\nY1000.\nM30\n";
        let options = "--allow feed,stop --strategy speed";
        let (code, text, errors) = shop.limit(program, options);
        assert_eq!(code, 0, "{controller}: {errors}");
        let expected = format!("G90\n{word} G1 X1000. F20000.\nY1000.\nM30\n");
        assert_eq!(text, expected, "{controller}");
    }
}

/// On a control without a word for one block, G64 comes back as it was written.
#[test]
fn g64_comes_back_with_its_tolerance() {
    let shop = Shop::straight("iso", 600.0);
    for mode in ["G64", "G64 P0.02"] {
        let program = format!("G21 G90 {mode}\nG0 X1000. Y800.\nG1 X1010. F1000\nM30\n");
        let (code, text, errors) = shop.limit(&program, "--allow feed");
        assert_eq!(code, 0, "{errors}");
        assert!(
            text.contains(&format!("\n{mode}\nG1 X1010. F1000\n")),
            "{text}"
        );
    }
}

/// Where no dwell is known to stop the axes, the word stands in the block before a rapid that
/// becomes a feed and in its own; at 600 W both axes may run at F26404.
#[test]
fn rapids_between_two_words() {
    let limited_to_600_w =
        |program: &str| Shop::straight("okuma", 600.0).limit(program, "--allow feed");
    let (code, text, errors) = limited_to_600_w(
        "G0 X1000. Y800.\nG1 X5. F500\nX8.\nG0 X0. Y0.\nG1 X3. F400\nG61 X2.\nG0 X1000. Y802.\n\
         G64\nM30\n",
    );
    assert_eq!(code, 0, "{errors}");
    assert_eq!(
        text,
        "G9 G1 X1000. Y800. F26404.\nG1 X5. F500\nX8.\nG0 X0. Y0.\nG1 X3. F400\nG61 X2.\n\
         G1 X1000. Y802. F26364.\nG64\nG0 F400\nM30\n"
    );
    // Each run of the block before ends at a rapid; the feed of a cycle does not stop, its way
    // back does.
    let (_, text, _) = limited_to_600_w(
        "V1=1\nN1 G1 Z-5. F300\nG0 X1000. Y800.\nX0. Y0.\nV1=V1+1\nIF [V1 LT 4] N1\nG81 X5. Y5. Z-3. R2. F300 M54\n\
         G0 X1000. Y800.\nM30\n",
    );
    assert!(
        text.contains("N1 G9 G1 Z-5. F300\nG9 G1 X1000. Y800."),
        "{text}"
    );
    // A block that is blended with a feed in one run must not be stopped.
    let program = "V1=1\nN1 G1 X5. F300\nIF [V1 EQ 2] N2\nG0 X1000. Y800.\nV1=2\nGOTO N1\nN2 G1 \
                   X9. Y9.\nM30\n";
    let (code, _, errors) = limited_to_600_w(program);
    assert_eq!(code, 1, "{program}");
    assert!(errors.contains("without its stop"), "{errors}");
}

/// Where no word for one block is known, G61 stands before both and G64 after them; among feeds per
/// revolution that one is by the minute.
#[test]
fn rapids_in_exact_stop_mode() {
    let lathe = Shop::lathe("okuma-lathe", 700.0, "");
    let program =
        "G50 S2000\nG97 S500 M3\nG0 X200. Z100.\nG1 Z50. F0.2\nX190.\nG0 X600. Z300.\nM2\n";
    let (code, text, errors) = lathe.limit(program, "");
    assert_eq!(code, 0, "{errors}");
    assert!(
        text.contains("\nG61\nX190.\nG94\nG1 X600. Z300. F"),
        "{text}"
    );
    let (code, _, errors) = lathe.limit(&text, "");
    assert_eq!(code, 0, "{errors}");
}

/// Where M6 stands in a block that moves, the axes rest before it or after it, as the machine
/// file says, and elsewhere the corner is rounded (392 W, 267 W at rest); where nothing says
/// it, neither is counted on.
#[test]
fn axes_rest_where_the_tool_changes() {
    let first = "G90 G64\nG1 X1000. F20000. M6\nY1000.\nM2\n";
    let second = "G90 G64\nG1 X1000. F20000.\nY1000. M6\nM2\n";
    let apart = "G90 G64\nG1 X1000. F20000.\nM6\nY1000.\nM2\n";
    for (order, expected) in [
        ("before-motion", ["392 W", "267 W", "267 W"]),
        ("after-motion", ["267 W", "392 W", "267 W"]),
        ("", ["683 W", "683 W", "267 W"]),
    ] {
        let language = match order {
            "" => String::new(),
            order => format!("[language]\ntool_change = \"{order}\"\n"),
        };
        let rest = format!("[path]\nrapid = \"linear\"\n{language}");
        let shop = Shop::mill("own.toml", "peak_power_w = 450", &rest, "");
        let profile = include_str!("../../machine-configs/controllers/linuxcnc.toml");
        let lines = profile
            .lines()
            .filter(|line| !line.starts_with("tool_change"));
        shop.put("own.toml", &lines.collect::<Vec<_>>().join("\n"));
        for (program, peak) in [first, second, apart].iter().zip(expected) {
            shop.put("a.nc", program);
            let (_, out, errors) = shop.run("check a.nc");
            assert!(
                out.contains(&format!("peak {peak}")),
                "{order}: {out}{errors}"
            );
        }
    }
}

/// A control that stops at each block until G64 needs that there alone.
#[test]
fn rapids_after_g64() {
    let shop = Shop::straight("iso", 600.0);
    let program = "G0 X1000. Y800.\nG64\nG1 X5. F500\nX8.\nG0 X1008. Y0.\nG1 X3. F400\nM30\n";
    let (code, text, errors) = shop.limit(program, "--allow feed");
    assert_eq!(code, 0, "{errors}");
    assert_eq!(
        text,
        "G1 X1000. Y800. F26404\nG64\nG1 X5. F500\nG61\nX8.\nG1 X1008. Y0. F26404\nG64\n\
         G1 X3. F400\nM30\n"
    );
    let (code, _, errors) = shop.limit(&text, "--allow feed");
    assert_eq!(code, 0, "{errors}");
    assert!(errors.contains("fits as it is"), "{errors}");
}

/// Where the profile has no word, and where no stop is needed, a message says so.
#[test]
fn a_control_without_the_word() {
    let program = "G90 G64\nG1 X1000. F20000.\nY1000.\nM2\n";
    for (controller, reason) in [
        (
            "iso",
            "the controller `iso` names no word for an exact stop",
        ),
        ("linuxcnc", "the planner of `linuxcnc` is modelled"),
    ] {
        let shop = Shop::straight(controller, 450.0);
        let (code, with, errors) = shop.limit(program, "--allow feed,stop");
        assert_eq!(code, 0, "{controller}: {errors}");
        assert!(errors.contains("warning[no-stop-word]"), "{errors}");
        assert!(errors.contains(reason), "{errors}");
        let (_, without, errors) = shop.limit(program, "--allow feed");
        assert_eq!(with, without);
        assert!(!errors.contains("no-stop-word"), "{errors}");
    }
}

/// Nothing is put into blocks with a path mode of their own, and where the
/// start is not known or nothing of the control is to be relied on.
#[test]
fn where_no_stop_is_put() {
    let plain = "G1 X1000. F20000.\nY1000.\n";
    for (program, options) in [
        (
            "G21 G90 G64\nG64 G1 X1000. F20000.\nG64 Y1000.\nM30\n".to_owned(),
            "",
        ),
        (format!("G21 G90 G64\n{plain}M30\n"), "--start unknown"),
        (format!("G21 G90 G64\n{plain}M30\n"), "--certificate robust"),
    ] {
        let shop = Shop::straight("fanuc", 450.0);
        shop.put("tools.tbl", "T1 P1 D4\n");
        let all = format!("--allow feed,stop {options}");
        let (_, text, errors) = shop.limit(&program, all.trim_end());
        assert!(!text.contains("G9 "), "{program}{text}{errors}");
    }
}

/// Feeds that mean something else stay as they are; a stop changes none.
#[test]
fn stops_among_feeds_of_another_meaning() {
    let shop = Shop::straight("haas", 450.0);
    let program = "G21 G90 G64\nG93 G1 X1000. F20.\nY1000. F20.\nG94\nM30\n";
    let (code, text, errors) = shop.limit(program, "--allow feed,stop");
    assert_eq!(code, 0, "{errors}");
    assert!(
        text.contains("G93 G9 G1 X1000. F20.\n") || text.contains("G9 G93 G1 X1000. F20.\n"),
        "{text}"
    );
    assert!(text.contains("\nY1000. F20.\n"), "{text}");
}

/// A line that runs several times has its stop each time.
#[test]
fn a_loop_has_the_stop_in_each_run() {
    let shop = Shop::straight("fanuc", 450.0);
    let program = "G21 G90 G64\n#1=0\nWHILE [#1 LT 3] DO1\nG1 X1000. F20000.\nY1000.\nX0.\nY0.\n\
                   #1=#1+1\nEND1\nM30\n";
    let (code, text, errors) = shop.limit(program, "--allow feed,stop");
    assert_eq!(code, 0, "{errors}");
    assert_eq!(text.matches("G9 ").count(), 4, "{text}");
    assert!(!text.contains(" F1"), "{text}");
    assert_eq!(text.replace("G9 ", ""), program);
}

/// The blocks of a modal macro call stay its blocks: the macro runs after each of them.
#[test]
fn a_modal_macro_call_goes_on() {
    let shop = Shop::straight("fanuc", 450.0);
    let program = "G21 G90 G64\nG66 P1\nG1 X1000. F20000.\nY1000.\nG67\nM30\nO1\nG4 X1.\nM99\n";
    let (code, text, errors) = shop.limit(program, "--allow feed,stop");
    assert_eq!(code, 0, "{errors}");
    shop.put("out.nc", &text);
    assert_eq!(moves(&shop, "a.nc"), moves(&shop, "out.nc"), "{text}");
}

/// What moves, in order: kind, end and arc.
fn moves(shop: &Shop, name: &str) -> Vec<String> {
    let (code, out, errors) = shop.run(&format!("moves {name}"));
    assert_eq!(code, 0, "{errors}");
    let rows = out.lines().map(|line| {
        let mv: serde_json::Value = serde_json::from_str(line).expect("a move");
        format!(
            "{} {} {} {}",
            mv["kind"], mv["end"], mv["center"], mv["turns"]
        )
    });
    rows.collect()
}

fn block() -> impl Strategy<Value = String> {
    let place = -300..300;
    let feed = prop::sample::select(vec!["", " F20000.", " F3000.", " F9000."]);
    prop_oneof![
        6 => (place.clone(), feed.clone()).prop_map(|(x, f)| format!("G1 X{x}.{f}\n")),
        6 => (place.clone(), feed.clone()).prop_map(|(y, f)| format!("G1 Y{y}.{f}\n")),
        4 => (place.clone(), place.clone(), feed).prop_map(|(x, y, f)| format!("G1 X{x}. Y{y}.{f}\n")),
        1 => place.clone().prop_map(|z| format!("G0 Z{z}.\n")),
        1 => place.prop_map(|x| format!("G3 X{x}. R400.\n")),
        1 => prop::sample::select(vec!["G4 P100\n", "M8\n", "G61\n", "G64\n", "/G1 X5.\n"]).prop_map(str::to_owned),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

    /// Whatever fits without stops fits with them, over the same moves; and no feed is
    /// lower for the stops but where its block was not lowered before.
    #[test]
    fn stops_change_no_path(blocks in prop::collection::vec(block(), 2..14), power_w in 430.0..640.0_f64) {
        let shop = Shop::straight("fanuc", power_w);
        let program = format!("G21 G90 G64\nG1 X0. F20000.\n{}M30\n", blocks.concat());
        let without = shop.limit(&program, "--allow feed -o without.nc");
        let with = shop.limit(&program, "--allow feed,stop -o with.nc");
        if without.0 == 0 {
            prop_assert_eq!(with.0, 0, "{}{}", program, with.2);
        }
        if with.0 == 0 {
            prop_assert_eq!(
                moves(&shop, "a.nc").into_iter().filter(|it| !it.contains("dwell")).count(),
                moves(&shop, "with.nc").into_iter().filter(|it| !it.contains("dwell")).count()
            );
            let (code, _, errors) = shop.run("check with.nc");
            prop_assert_eq!(code, 0, "{}", errors);
        }
    }
}
