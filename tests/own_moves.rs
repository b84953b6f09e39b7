//! Moves that a machine makes of itself: at a tool change, and by words of its builder.

use insta::assert_snapshot;

use crate::listing::{listing, machine_of};

/// The moves of a program under these lines of `[language]`; `more` stands before them.
fn moves(controller: &str, language: &str, program: &str) -> String {
    let more = format!("[language]\n{language}\n");
    listing(program, &machine_of(controller, &more, "XYZ", ""), None)
}

/// M6 sends Z from the cut to its reference point on a Haas, and a rapid comes back from there.
#[test]
fn z_goes_up_for_the_tool() {
    let program = "G54 G0 X10 Z-5\nT2 M6\nG0 X20\nG0 Z5\nM30\n";
    let up = moves("haas", "units = \"mm\"", program);
    assert_snapshot!(up, @r"
    1 rapid X10 Z-5
    2 rapid Z0
    3 rapid X20
    4 rapid Z5
    ");
    assert_eq!(
        up,
        moves(
            "fanuc",
            "units = \"mm\"\ntool_change_moves = [\"Z\"]",
            program
        )
    );
    let stays = moves("haas", "units = \"mm\"\ntool_change_moves = []", program);
    assert_snapshot!(stays, @r"
    1 rapid X10 Z-5
    3 rapid X20
    4 rapid Z5
    ");
}

/// An axis at its reference point stays there.
#[test]
fn z_at_its_reference_point_stays() {
    let program = "G0 X10 Z-5\nG91 G28 Z0\nG90 T2 M6\nG0 X20\nM30\n";
    let language = "units = \"mm\"";
    assert_eq!(
        moves("haas", language, program),
        moves("haas", "units = \"mm\"\ntool_change_moves = []", program)
    );
}

/// A word of the builder counts as all axes at full speed; next to axes it is refused.
#[test]
fn a_word_of_the_builder_moves_all() {
    let language = "units = \"mm\"\nunknown_moves = [\"M400\", \"G88.6\", \"M6\"]";
    let program = "G0 X10\nM400\nG0 X20\nG88.6 P1\nG0 Y3\nT2 M6\nG0 Y4\nM30\n";
    assert_snapshot!(moves("fanuc", language, program), @r"
    1 rapid X10
    2 feed
    3 rapid
    4 feed
    5 rapid
    6 feed
    7 rapid
    ");
    let refused = moves("fanuc", language, "M400 X5\nM30\n");
    assert!(
        refused.contains("the block moves axes next to M400, whose moves are not known"),
        "{refused}"
    );
}
