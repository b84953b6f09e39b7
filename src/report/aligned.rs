//! Tables for people.

use unicode_width::UnicodeWidthStr;

/// Columns between two cells.
pub(super) const GAP: usize = 2;

/// Rows as a table: columns as wide as their widest cell, two blanks apart.
pub(super) fn aligned<const N: usize>(rows: &[[String; N]], indent: &str) -> String {
    let widths = widths(rows);
    let mut text = String::new();
    for row in rows {
        let mut line = String::from(indent);
        for (width, cell) in widths.iter().zip(row) {
            line.push_str(cell);
            line.extend(std::iter::repeat_n(' ', width - cell.width() + GAP));
        }
        text.push_str(line.trim_end());
        text.push('\n');
    }
    text
}

/// Columns of a terminal that the cells of each column take: those of Chinese, Japanese and
/// Korean take two each (Unicode Standard Annex 11).
pub(super) fn widths<const N: usize>(rows: &[[String; N]]) -> [usize; N] {
    let mut widths = [0; N];
    for row in rows {
        for (width, cell) in widths.iter_mut().zip(row) {
            *width = (*width).max(cell.width());
        }
    }
    widths
}

#[cfg(test)]
mod tests {
    use super::aligned;

    #[test]
    fn wide_characters_take_two_columns() {
        let rows = [["テスト.nc", "1"], ["e\u{301}.nc", "22"]].map(|row| row.map(String::from));
        assert_eq!(
            aligned(&rows, " "),
            " テスト.nc  1\n e\u{301}.nc       22\n"
        );
    }
}
