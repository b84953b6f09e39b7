//! `[[levels]]`: what is read, and every message about them.

use super::{edited, findings, machine};
use gwatt::machine::KnobTarget;

/// The base machine with another controller and levels.
fn with(controller: &str, more: &str) -> String {
    let text = edited(
        "controller = \"iso\"",
        &format!("controller = \"{controller}\""),
    );
    format!("{text}{more}\n")
}

/// The first finding in a machine with these levels.
fn first(controller: &str, more: &str) -> String {
    let found = findings(&with(controller, more));
    found.lines().next().unwrap_or_default().to_owned()
}

/// X has 6000 mm/s² and B 1150 degrees/s²: what is not named is the axis' own, and the
/// gentlest level comes first.
#[test]
fn levels_are_read_in_their_order() {
    let machine = machine(&with(
        "haas",
        "[[levels]]\nacts_on = \"feeds\"\nlevel = [\
         { word = \"G187 P1\", accel_percent = 200 },\
         { word = [\"G187 P2\", \"g187\"], power_on = true },\
         { word = \"G187 P3\", accel_mm_s2 = { X = 1500 } }]\n\
         [[levels]]\nacts_on = \"rapids\"\nchange_s = 0.02\nlevel = [\
         { word = \"M131\", rapid_percent = 25 },\
         { word = \"M132\", power_on = true }]",
    ));
    let [smoothness, rapid] = machine.controller.knobs.as_slice() else {
        panic!("{:?}", machine.controller.knobs);
    };
    assert_eq!(smoothness.target, KnobTarget::FeedAccel);
    assert!(smoothness.verified && !smoothness.between_moves);
    assert_eq!(smoothness.name, "G187 P3, G187 P2, G187 P1");
    let levels = smoothness.levels.as_ref().expect("levels");
    let accels = levels
        .list
        .iter()
        .map(|level| [level.accel_mm_s2[0], level.accel_mm_s2[4]]);
    assert_eq!(
        accels.collect::<Vec<_>>(),
        [[1500.0, 1150.0], [6000.0, 1150.0], [12000.0, 2300.0]]
    );
    assert_eq!(levels.power_on, 1);
    assert_eq!(levels.list[1].words[1].text, "G187");
    assert_eq!(rapid.target, KnobTarget::RapidSpeed);
    assert!(!rapid.verified);
    assert_eq!(rapid.change_s, 0.02);
    assert_eq!(
        rapid.levels.as_ref().expect("levels").list[0].rapid_factor,
        0.25
    );
}

const TWO: &str = "level = [{ word = \"G187 P1\", accel_percent = 200 }, { word = \"G187 P2\", power_on = true }]";

#[test]
fn what_cannot_be_is_said() {
    let pair = |first: &str, second: &str| {
        format!("[[levels]]\nacts_on = \"feeds\"\nlevel = [{{ {first} }}, {{ {second} }}]")
    };
    let p1 = "word = \"G187 P1\", accel_percent = 200";
    let p2 = "word = \"G187 P2\", power_on = true";
    for (controller, more, said) in [
        ("haas", "[[levels]]\nacts_on = \"feeds\"\nlevel = [{ word = \"G187 P1\" }]".to_owned(),
         "levels need at least two words to choose from"),
        ("haas", pair(p1, "word = \"G187 P2\""),
         "none of these levels has power_on = true: which one holds at the start?"),
        ("haas", pair(&format!("{p1}, power_on = true"), p2),
         "two of these levels have power_on = true"),
        ("haas", pair("word = \"G187 P1\"", p2),
         "none of these levels has an acceleration or a speed"),
        ("haas", pair("word = \"G187 P1\", accel_percent = 2000", p2),
         "20 times the acceleration of the axes / 2000 mm/s² are 2 m/s²"),
        ("haas", pair("word = \"G187 P1\", accel_mm_s2 = { X = 90000 }", p2),
         "15 times the acceleration of axis X / 2000 mm/s² are 2 m/s²"),
        ("haas", pair("word = \"G187 P1\", accel_mm_s2 = { Y = 9000 }", p2),
         "the machine has no axis Y"),
        ("haas", pair("word = \"G187 P1\", accel_percent = 50, accel_mm_s2 = { X = 9000 }", p2),
         "accelerations are given twice, in percent and in mm/s²"),
        ("haas", pair("word = \"G187 P1\", rapid_percent = 50", p2),
         "a speed of rapids in levels that act on feeds / acts_on = \"rapids\" or \"all\""),
        ("haas", pair(p1, "word = \"G187 P1\", power_on = true"),
         "\"G187 P1\" cannot select a level: it is given twice"),
        ("haas", pair("word = \"G1\", accel_percent = 50", p2),
         "\"G1\" cannot select a level: it is none of the G words that move nothing (`ignored` in \
          the controller profile, or under [language])"),
        ("haas", pair("word = \"M8\", accel_percent = 50", p2),
         "\"M8\" cannot select a level: it has a meaning of its own"),
        ("haas", pair("word = \"M98\", accel_percent = 50", p2),
         "\"M98\" cannot select a level: it has a meaning of its own"),
        ("haas", pair("word = \"DYNFINISH\", accel_percent = 50", p2),
         "\"DYNFINISH\" is no word that could select a level / such as \"G187 P1\", \"M31\" or, on \
          a SINUMERIK, \"DYNFINISH\""),
        ("haas", pair("word = \"G187 X1\", accel_percent = 50", p2),
         "\"G187 X1\" is no word that could select a level / such as \"G187 P1\", \"M31\" or, on a \
          SINUMERIK, \"DYNFINISH\""),
        ("siemens", pair("word = \"SOFT\", accel_percent = 50", "word = \"DYNNORM\", power_on = true"),
         "\"SOFT\" cannot select a level: it is none of the dynamic modes"),
        ("linuxcnc", pair("word = \"M131\", accel_percent = 50", "word = \"M132\", power_on = true"),
         "\"M131\" cannot select a level: the controller `linuxcnc` is not known to have such a word"),
        ("haas", format!("[[load]]\non = \"M131\"\noff = \"M134\"\npower_w = 5\n{}",
         pair("word = \"M131\", accel_percent = 50", "word = \"M132\", power_on = true")),
         "\"M131\" cannot select a level: it switches a [[load]]"),
        ("haas", format!("[[levels]]\nacts_on = \"feeds\"\nbetween_moves = true\nchange_s = 0.1\n{TWO}"),
         "the axes stand for `change_s`: then the word does not act between moves"),
        ("haas", format!("{}\n{}", pair(p1, p2),
         pair("word = \"M131\", accel_percent = 50", "word = \"M132\", power_on = true")),
         "these levels and `G187 P2, G187 P1` act on the same moves: what both make of them is not \
          known"),
        ("haas", (0..5).fold(String::new(), |text, group| format!(
            "{text}[[levels]]\nacts_on = \"rapids\"\nlevel = [{{ word = \"M{}\", accel_percent = 50 }}, \
             {{ word = \"M{}\", power_on = true }}]\n", 130 + group, 140 + group)),
         "these levels and `M130, M140` act on the same moves: what both make of them is not known"),
    ] {
        let found = first(controller, &more);
        assert!(found.contains(said), "{found}\nfor {more}\nis not {said}");
        assert!(found.contains("error machine-levels: "), "{found}");
    }
    let five = (0..5).fold(String::new(), |text, group| {
        format!(
            "{text}[[levels]]\nacts_on = \"rapids\"\nlevel = [{{ word = \"M{}\", accel_percent = 50 }}, \
             {{ word = \"M{}\", power_on = true }}]\n",
            130 + group,
            140 + group
        )
    });
    assert!(findings(&with("haas", &five)).contains("more than 4 groups of levels"));
}
