//! Letters of words, as places in tables and as bits.

/// Words that have a place of their own: the letters, `@` and `^`.
pub(super) const SLOTS: usize = 28;

/// Place of a letter in the tables of this module.
pub(super) const fn slot(letter: u8) -> usize {
    match letter {
        b'@' => 26,
        b'^' => 27,
        _ => (letter - b'A') as usize,
    }
}

/// The letter at a place.
pub(super) fn letter_of(slot: u32) -> u8 {
    match slot {
        26 => b'@',
        27 => b'^',
        _ => b'A' + slot as u8,
    }
}

/// Bit of a letter in the masks of this module.
pub(super) const fn bit(letter: u8) -> u32 {
    1 << slot(letter)
}

/// Polar coordinates: distance and angle.
pub(super) const POLAR: u32 = bit(b'@') | bit(b'^');

/// Letters that name axes.
pub(super) const AXIS_LETTERS: u32 = bit(b'X')
    | bit(b'Y')
    | bit(b'Z')
    | bit(b'A')
    | bit(b'B')
    | bit(b'C')
    | bit(b'U')
    | bit(b'V')
    | bit(b'W')
    | bit(b'E');
