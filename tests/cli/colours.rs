//! Colours of verdicts and differences, and lists that keep to the width of a terminal.

use std::io::Cursor;

use gwatt::machine::Machine;
use gwatt::pipeline::{Options, analyze};
use gwatt::report::{Checked, Style, check_text};

use crate::shop::Shop;

const GREEN: &str = "\u{1b}[1m\u{1b}[32m";
const RED: &str = "\u{1b}[1m\u{1b}[31m";
const END: &str = "\u{1b}[0m";

fn mill(peak_w: f64) -> Shop {
    let converter = format!("peak_power_w = {peak_w}");
    let shop = Shop::mill("fanuc", &converter, "[path]\nrapid = \"linear\"", "");
    shop.put("part.nc", "G21 G90\nG0 X200. Y100.\nM30\n");
    shop
}

/// What is right is green, what is not is red, and pipes get neither.
#[test]
fn verdicts_have_colours() {
    let shop = mill(1e6);
    let (_, shown, _) = shop.run("check part.nc --color always");
    assert!(
        shown.starts_with(&format!("part.nc: {GREEN}fits{END}: peak")),
        "{shown}"
    );
    let (_, shown, _) = shop.run("check part.nc");
    assert!(shown.starts_with("part.nc: fits: peak"), "{shown}");
    let shop = mill(400.0);
    let (_, shown, _) = shop.run("check part.nc --color always");
    assert!(
        shown.starts_with(&format!("part.nc: {RED}does not fit{END}: ")),
        "{shown}"
    );
    let (_, _, shown) = shop.run("limit part.nc --color always -o fit.nc");
    assert!(
        shown.contains(&format!("part.nc: {GREEN}fits now{END}: ")),
        "{shown}"
    );
    shop.put("bad.nc", "G21 G90\nG777\n");
    let (_, shown, _) = shop.run("check bad.nc --color always");
    assert!(
        shown.starts_with(&format!("bad.nc: {RED}refused{END}: ")),
        "{shown}"
    );
    let narrow = mill(150.0);
    narrow.put("part.nc", "G21 G90\nG1 X200. F20000.\nM30\n");
    let (_, _, shown) = narrow.run("limit part.nc --color always -o fit.nc");
    let refused = format!("part.nc: {RED}cannot be made to fit{END} (1 reason)");
    assert!(shown.contains(&refused), "{shown}");
}

/// Lines that go are red, those that come are green, all others stay as they are.
#[test]
fn differences_have_colours() {
    let shop = mill(400.0);
    let (_, plain, _) = shop.run("limit part.nc --dry-run");
    let (_, shown, _) = shop.run("limit part.nc --dry-run --color always");
    let coloured: String = plain
        .split_inclusive('\n')
        .map(|line| {
            let text = line.trim_end_matches('\n');
            match line.as_bytes()[0] {
                b'-' => format!("{RED}{text}{END}\n"),
                b'+' => format!("{GREEN}{text}{END}\n"),
                _ => line.to_owned(),
            }
        })
        .collect();
    assert!(plain.contains("\n-G0 X200. Y100.\n+"), "{plain}");
    assert_eq!(shown, coloured);
    let both = super::Shop::new();
    let weak = shop.get("mill.toml");
    both.put("part.nc", shop.get("part.nc"));
    both.put("weak.toml", &weak);
    both.put("strong.toml", weak.replace("= 400", "= 100000"));
    for (from, to, verdict) in [
        (
            "weak.toml",
            "strong.toml",
            format!("{GREEN}begins to fit{END}"),
        ),
        (
            "strong.toml",
            "weak.toml",
            format!("{RED}ceases to fit{END}"),
        ),
    ] {
        let ran = both.run(&[
            "diff", "part.nc", "--from", from, "--to", to, "--color", "always",
        ]);
        let expected = format!("part.nc: line 2 {verdict}\n");
        assert!(ran.stdout.contains(&expected), "{}", ran.stdout);
    }
}

/// The program's text gives way, and nothing else.
#[test]
fn lists_keep_to_the_width_of_the_terminal() {
    let machine = Machine::from_toml("mill.toml", &mill(400.0).get("mill.toml")).unwrap();
    let machine = machine.0;
    let program = format!(
        "G21 G90\nG0 X200. Y100. ({})\nM30\n",
        "a long remark ".repeat(9)
    );
    let input = Cursor::new(program.as_bytes());
    let summary = analyze(input, &machine, &Options::default(), None).unwrap();
    let checked = Checked {
        program: "part.nc".to_owned(),
        outcome: Ok(summary),
        changes: None,
        held: None,
    };
    let listing = |columns: Option<usize>| {
        let style = Style {
            colour: false,
            columns,
        };
        check_text(&checked, &machine, style)
    };
    let listed = |columns| listing(columns).lines().nth(1).unwrap().to_owned();
    let whole = listed(None);
    assert!(whole.contains("a long remark a long remark") && whole.contains('…'));
    for columns in [90, 100, 130] {
        let line = listed(Some(columns));
        assert_eq!(line.chars().count(), columns, "{line}");
        assert_eq!(
            line.split_once('→'),
            Some((
                line.split('→').next().unwrap(),
                whole.split_once('→').unwrap().1
            ))
        );
    }
    // Where it is too narrow for both, what helps gets a line of its own.
    let text = listing(Some(60));
    let lines: Vec<&str> = text.lines().skip(1).collect();
    assert!(
        lines[0].contains("G0 X200. Y1") && lines[0].ends_with('…'),
        "{text}"
    );
    assert_eq!(lines[0].chars().count(), 60, "{text}");
    assert!(lines[1].starts_with("    → fits with G1 F"), "{text}");
}
