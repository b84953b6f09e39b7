//! Names of profiles in a sentence.

/// Profiles that read the same words up to details, the best known first.
pub(super) const FAMILIES: [&[&str]; 2] = [
    &[
        "fanuc",
        "haas",
        "mitsubishi",
        "mazak",
        "syntec",
        "fanuc-lathe",
        "fanuc-lathe-b",
        "haas-lathe",
    ],
    &["marlin", "reprap", "klipper"],
];

/// The profiles as in "siemens", "fanuc-lathe or haas-lathe", or "fanuc or one of its
/// relatives (haas, mitsubishi, mazak, syntec)".
#[must_use]
pub fn listed(profiles: &[&str]) -> String {
    let mut rest: Vec<&str> = profiles.to_vec();
    let mut parts = Vec::new();
    for family in FAMILIES {
        let members: Vec<&str> = family
            .iter()
            .filter(|name| rest.contains(name))
            .copied()
            .collect();
        let [first, relatives @ ..] = members.as_slice() else {
            continue;
        };
        if relatives.len() < 2 || family.first() != Some(first) {
            continue;
        }
        parts.push(format!(
            "{first} or one of its relatives ({})",
            relatives.join(", ")
        ));
        rest.retain(|name| !members.contains(name));
    }
    let single = rest.into_iter().map(str::to_owned);
    let all: Vec<String> = single.chain(parts).collect();
    match all.as_slice() {
        [] => "none".to_owned(),
        [one] => one.clone(),
        [front @ .., last] => format!("{} or {last}", front.join(", ")),
    }
}
