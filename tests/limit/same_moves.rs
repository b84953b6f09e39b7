//! Whether a limited program goes to the same places.

use crate::shop::Shop;

/// Ends of the moves that take time, in mm.
pub(super) fn ends(shop: &Shop, name: &str) -> Vec<[f64; 3]> {
    let (code, out, errors) = shop.run(&format!("moves {name}"));
    assert_eq!(code, 0, "{errors}");
    let mut ends = Vec::new();
    for line in out.lines() {
        let mv: serde_json::Value = serde_json::from_str(line).unwrap();
        let number = |name: &str, axis: &str| mv[name][axis].as_f64().unwrap();
        let place = |name: &str| ["X", "Y", "Z"].map(|axis| number(name, axis));
        let [start, end] = [place("start"), place("end")];
        // Places in polar words are rounded.
        let moves = (0..3).any(|axis: usize| (start[axis] - end[axis]).abs() > 1e-5);
        if mv["kind"] != "dwell" && moves {
            ends.push(place("end"));
        }
    }
    ends
}

#[track_caller]
pub(super) fn same_moves(shop: &Shop, context: &str) {
    let [before, after] = ["a.nc", "out.nc"].map(|name| ends(shop, name));
    assert_eq!(before.len(), after.len(), "{context}");
    for (a, b) in before.iter().zip(&after) {
        let near = a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-5);
        assert!(near, "{a:?} {b:?}\n{context}");
    }
}
