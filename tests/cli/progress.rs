//! The bar of long work: seen on a terminal while it lasts, and nothing of it afterwards.

use std::fmt::Write as _;
use std::process::Command;

use super::Shop;

/// What a terminal shows of a text in the end: carriage returns, erased lines and ways up.
pub(super) fn screen(text: &str) -> String {
    let mut lines = vec![String::new()];
    let (mut row, mut column) = (0, 0);
    let mut signs = text.chars().peekable();
    while let Some(sign) = signs.next() {
        match sign {
            '\r' => column = 0,
            '\n' => {
                (row, column) = (row + 1, 0);
                if row == lines.len() {
                    lines.push(String::new());
                }
            }
            '\u{1b}' => {
                assert_eq!(signs.next(), Some('['), "{text:?}");
                let mut number = String::new();
                while let Some(digit) = signs.next_if(|sign| !sign.is_ascii_alphabetic()) {
                    number.push(digit);
                }
                let number: usize = number.parse().unwrap_or(0);
                match signs.next() {
                    Some('K') if number == 2 => lines[row].clear(),
                    Some('K') => {
                        let kept = lines[row].chars().take(column).collect();
                        lines[row] = kept;
                    }
                    Some('A') => row -= number.max(1),
                    Some('B') => row += number.max(1),
                    Some('m') => {}
                    other => panic!("{other:?} in {text:?}"),
                }
            }
            sign => {
                let mut line: Vec<char> = lines[row].chars().collect();
                line.resize(line.len().max(column + 1), ' ');
                line[column] = sign;
                lines[row] = line.into_iter().collect();
                column += 1;
            }
        }
    }
    let lines: Vec<&str> = lines.iter().map(|line| line.trim_end()).collect();
    lines.join("\n").trim_end().to_owned()
}

/// Runs gwatt on a terminal of its own; `None` where there is no program that makes one.
fn on_a_terminal(shop: &Shop, arguments: &str) -> Option<String> {
    let gwatt = env!("CARGO_BIN_EXE_gwatt");
    let ran = Command::new("script")
        .args(["-qec", &format!("{gwatt} {arguments}"), "/dev/null"])
        .current_dir(shop.path())
        .env("TERM", "xterm")
        .env("NO_COLOR", "1")
        .env_remove("AXIS_PROGRESS_BAR")
        .output();
    match ran {
        Ok(ran) => Some(String::from_utf8(ran.stdout).unwrap()),
        Err(error) => {
            eprintln!("skipped: no terminal can be made (script: {error})");
            None
        }
    }
}

#[test]
fn a_bar_is_shown_and_taken_away() {
    let shop = Shop::new();
    let mut program = String::from("G21 G90 G94 G17\n");
    for number in 0..3000 {
        writeln!(program, "G1 X{} F500", number % 7).unwrap();
    }
    shop.put("long.ngc", &program);
    // How far the work is when it is first looked at depends on the machine.
    for (arguments, shown) in [
        ("check long.ngc", "long.ngc, pass "),
        ("check long.ngc gentle.ngc", "of 2 programs ["),
        ("limit long.ngc -o out.ngc", "long.ngc, pass "),
        ("report long.ngc -o rows.csv", "long.ngc, pass "),
        ("limit long.ngc gentle.ngc -o out", "of 2 programs ["),
        ("size gentle.ngc", "size, pass "),
        (
            "limit long.ngc gentle.ngc --with-subprograms -o set",
            "2 programs, ",
        ),
        ("limit long.ngc --with-subprograms -o one", "long.ngc, "),
    ] {
        let arguments = format!("{arguments} -m three-axis");
        let Some(seen) = on_a_terminal(&shop, &format!("{arguments} --progress always")) else {
            return;
        };
        let plain = on_a_terminal(&shop, &format!("{arguments} --progress never")).unwrap();
        let bar = |text: &str| {
            text.split('\r')
                .any(|line| line.contains(shown) && line.contains(" %  "))
        };
        assert!(bar(&seen), "{arguments}: {seen:?}");
        assert!(!bar(&plain), "{arguments}: {plain:?}");
        assert_eq!(screen(&seen), screen(&plain), "{arguments}: {seen:?}");
    }
}

/// Nothing appears of short work, nor with `-q`, nor where nobody looks.
#[test]
fn short_work_shows_none() {
    let shop = Shop::new();
    for arguments in ["check gentle.ngc", "check gentle.ngc -q"] {
        let Some(seen) = on_a_terminal(&shop, &format!("{arguments} -m three-axis")) else {
            return;
        };
        assert!(!seen.contains("pass"), "{seen:?}");
    }
    let ran = shop.run(&[
        "check",
        "gentle.ngc",
        "-m",
        "three-axis",
        "--progress",
        "always",
    ]);
    assert_eq!(ran.stderr, "");
}

#[test]
fn the_screen_of_the_test_erases() {
    assert_eq!(screen("a\r\u{1b}[2Kb\ncd\u{1b}[1A\r\u{1b}[2K"), "\ncd");
    assert_eq!(screen("bar\r\u{1b}[Kdone\r\n"), "done");
}
