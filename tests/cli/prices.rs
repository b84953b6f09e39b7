//! What `limit` says it would take where it cannot make a program fit.

use crate::shop::Shop;

/// Feeds at 0.417 m/s and a cycle, whose ways from hole to hole draw the most.
const PART: &str = "G21 G90 G40 G80\nG0 X0 Y0 Z50.\nG1 X200. F25000\nG1 X0\n\
    G81 X10. Z-5. R2. F500.\nX200. Y100.\nG80\nM30\n";

fn mill(peak_w: f64) -> Shop {
    let shop = Shop::mill(
        "fanuc",
        &format!("peak_power_w = {peak_w}"),
        "[path]\nrapid = \"linear\"",
        "",
    );
    shop.put("part.nc", PART);
    shop
}

/// The last line but blank ones.
fn last(shown: &str) -> &str {
    shown.lines().last().unwrap_or_default()
}

/// The permissions that are named are enough, and it takes as long as is said.
#[test]
fn the_price_is_what_limit_asks_for() {
    let feeds = "G21 G90\nG1 X200. F25000\nG0 Y0\nM30\n";
    for (part, expected) in [(PART, "feed,expand"), (feeds, "feed")] {
        let shop = mill(450.0);
        shop.put("part.nc", part);
        let (code, _, shown) = shop.run("limit part.nc -o fit.nc --json refused.json");
        assert_eq!(code, 1, "{shown}");
        let price = last(&shown).strip_prefix("with --allow ").expect(&shown);
        let (allow, times) = price.split_once(" it fits, in ").expect(price);
        let refused: serde_json::Value = serde_json::from_str(&shop.get("refused.json")).unwrap();
        assert_eq!(allow, expected);
        assert_eq!(refused["price"]["allow"], allow);
        let (code, _, shown) = shop.run(&format!(
            "limit part.nc -o fit.nc --allow {allow} --json fit.json"
        ));
        assert_eq!(code, 0, "{shown}");
        let fit: serde_json::Value = serde_json::from_str(&shop.get("fit.json")).unwrap();
        assert_eq!(
            fit["duration_after_s"],
            refused["price"]["duration_after_s"]
        );
        assert_eq!(fit["price"], serde_json::Value::Null);
        assert!(shown.contains(times.split(' ').next().unwrap()), "{shown}");
    }
}

/// Each permission that is enough by itself is named, and is enough.
#[test]
fn each_single_permission_that_is_enough_has_its_price() {
    let shop = mill(350.0);
    shop.put(
        "part.nc",
        "G21 G90 G64\nG1 X10. F20000.\nX20. Y2.\nX30.\nX40. Y2.\nM30\n",
    );
    let (code, _, shown) = shop.run("limit part.nc -o fit.nc --json refused.json");
    assert_eq!(code, 1, "{shown}");
    let refused: serde_json::Value = serde_json::from_str(&shop.get("refused.json")).unwrap();
    let prices = refused["prices"].as_array().expect("prices");
    let allowed: Vec<&str> = prices
        .iter()
        .filter_map(|it| it["allow"].as_str())
        .collect();
    assert_eq!(allowed, ["feed", "stop"], "{shown}");
    assert_eq!(refused["price"], prices[0]);
    for (allow, price) in allowed.iter().zip(prices) {
        let line = format!("with --allow {allow} it fits, in ");
        assert!(shown.contains(&line), "{shown}");
        let (code, _, errors) = shop.run(&format!(
            "limit part.nc -o fit.nc --allow {allow} --json fit.json"
        ));
        assert_eq!(code, 0, "{errors}");
        let fit: serde_json::Value = serde_json::from_str(&shop.get("fit.json")).unwrap();
        assert_eq!(
            fit["duration_after_s"], price["duration_after_s"],
            "{allow}"
        );
    }
}

/// What a reason says of the feed is what is written with the permission.
#[test]
fn the_feed_that_is_named_is_the_one_that_is_written() {
    let shop = Shop::mill("grbl", "peak_power_w = 350", "", "");
    let part = "G21 G90\nG1 X0.4 F24000\nX0.9 Y0.1\nX1.5 Y0.5\nX60\n";
    shop.put("part.nc", part);
    let (code, _, shown) = shop.run("limit part.nc -o fit.nc");
    assert_eq!(code, 1, "{shown}");
    let (code, _, _) = shop.run("limit part.nc -o fit.nc --allow feed");
    assert_eq!(code, 0);
    let fit = shop.get("fit.nc");
    let named = shown
        .lines()
        .filter_map(|line| line.split("it fits at ").nth(1));
    let named: Vec<&str> = named
        .filter_map(|it| it.split(": --allow").next())
        .collect();
    assert!(!named.is_empty(), "{shown}");
    for feed in named {
        let written = fit.split_whitespace().any(|word| word == feed);
        assert!(written, "{feed}\n{fit}");
    }
    // `check` and `report` name the same.
    let (_, checked, _) = shop.run("check part.nc");
    let (_, _, reported) = shop.run("report part.nc --csv rows.csv");
    assert!(checked.contains("fits with F"), "{checked}");
    let hint = |text: &str| -> Vec<String> {
        let hints = text.lines().filter_map(|line| line.split("→ ").nth(1));
        hints.map(str::to_owned).collect()
    };
    assert_eq!(hint(&checked), hint(&reported));
}

/// Where coolant alone draws too much no permission helps, and none is named.
#[test]
fn no_price_where_nothing_helps() {
    let load = "[[load]]\non = \"M8\"\noff = \"M9\"\npower_w = 500";
    let shop = Shop::mill("fanuc", "peak_power_w = 450", load, "");
    shop.put("part.nc", &format!("M8\n{PART}"));
    for more in ["", " --allow feed,expand", " --partial"] {
        let (code, _, shown) = shop.run(&format!("limit part.nc -o fit.nc{more}"));
        assert_eq!(code, 1, "{shown}");
        assert!(!shown.contains("it fits, in"), "{shown}");
    }
}

/// What has been read from a pipe is tried again too.
#[test]
fn programs_from_standard_input_have_a_price() {
    let shop = super::Shop::new();
    shop.put("mill.toml", mill(450.0).get("mill.toml"));
    shop.put("part.nc", PART);
    let from_file = shop.run(&["limit", "part.nc", "-m", "mill.toml"]);
    assert!(last(&from_file.stderr).starts_with("with --allow feed,expand it fits"));
    let ran = shop.run_with_input(&["limit", "-", "-m", "mill.toml"], PART);
    assert_eq!(ran.code, 1);
    assert_eq!(last(&ran.stderr), last(&from_file.stderr));
}
