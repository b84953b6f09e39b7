//! Columns that are given by hand: `torque=Iq*0.58Nm/A`.

use std::str::FromStr;

use super::column::{Meaning, quantity_of, unit_of, units_of};
use super::error::{IdentifyError, Outcome};
use super::header_name::suffix_of;

/// A column and what it holds.
#[derive(Debug, Clone, PartialEq)]
pub struct MappedColumn {
    /// Its name, or `#` and its number from 1 on.
    pub column: String,
    /// Quantity, kind and factor to SI.
    pub meaning: Meaning,
}

const HELP: &str = "write QUANTITY=COLUMN*FACTOR and a unit, such as torque=Iq*0.58Nm/A, position=Enc*0.001mm or time=#1*1ms";

impl FromStr for MappedColumn {
    type Err = IdentifyError;

    /// Reads `QUANTITY=COLUMN*FACTOR UNIT`; what stands after a `/` of the unit is what the
    /// column counts in, and does not matter. Without a factor it is 1.
    fn from_str(text: &str) -> Outcome<Self> {
        let wrong = |what: String| IdentifyError::new(format!("--map {text}: {what}"), HELP);
        let (quantity, rest) = text
            .split_once('=')
            .ok_or_else(|| wrong("there is no =".to_owned()))?;
        let quantity = quantity_of(quantity.trim())
            .ok_or_else(|| wrong(format!("{} is no quantity", quantity.trim())))?;
        let (column, scale) = rest
            .rsplit_once('*')
            .ok_or_else(|| wrong("there is no factor with a unit".to_owned()))?;
        let scale = scale.trim();
        // An exponent has a sign or a digit after its e.
        let end = scale
            .char_indices()
            .find(|(at, c)| {
                let is_exponent = *c == 'e'
                    && scale
                        .get(at + 1..)
                        .and_then(|rest| rest.chars().next())
                        .is_some_and(|next| next.is_ascii_digit() || next == '-' || next == '+');
                !(c.is_ascii_digit() || ".+-".contains(*c) || is_exponent)
            })
            .map_or(scale.len(), |(at, _)| at);
        let (factor, unit) = scale.split_at(end);
        let factor: f64 = if factor.is_empty() {
            1.0
        } else {
            factor
                .parse()
                .map_err(|_| wrong(format!("{factor} is no number")))?
        };
        if !factor.is_finite() || factor == 0.0 {
            return Err(wrong(format!("a factor of {factor} leaves nothing")));
        }
        let unit = unit.trim();
        let (kind, to_si) = unit_of(quantity, &suffix_of(unit))
            .or_else(|| {
                let (unit, _) = unit.rsplit_once('/')?;
                unit_of(quantity, &suffix_of(unit))
            })
            .ok_or_else(|| {
                wrong(format!(
                    "{} is none of its units: {}",
                    if unit.is_empty() { "nothing" } else { unit },
                    units_of(quantity)
                ))
            })?;
        Ok(Self {
            column: column.trim().to_owned(),
            meaning: Meaning {
                quantity,
                kind,
                to_si: to_si * factor,
            },
        })
    }
}

impl MappedColumn {
    /// Which of these columns it is.
    ///
    /// # Errors
    ///
    /// When there is none.
    pub fn index(&self, names: &[String]) -> Outcome<usize> {
        let number = self
            .column
            .strip_prefix('#')
            .and_then(|n| n.parse::<usize>().ok());
        let by_number = number
            .and_then(|number| number.checked_sub(1))
            .filter(|index| *index < names.len());
        let is_ours = |name: &String| {
            let bare = name.split(['[', '(']).next().unwrap_or_default();
            [name.trim(), bare.trim()]
                .into_iter()
                .any(|name| name.eq_ignore_ascii_case(&self.column))
        };
        by_number
            .or_else(|| names.iter().position(is_ours))
            .ok_or_else(|| {
                IdentifyError::new(
                    format!("--map: there is no column {}", self.column),
                    format!("the columns are: {}", names.join(", ")),
                )
            })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::column::{Kind, Quantity};

    fn read(text: &str) -> (String, Quantity, Kind, f64) {
        let MappedColumn { column, meaning } = text.parse().unwrap();
        (column, meaning.quantity, meaning.kind, meaning.to_si)
    }

    #[test]
    fn a_factor_takes_a_column_to_a_quantity() {
        let column = |text: &str| text.to_owned();
        for (text, expected) in [
            (
                "torque=Iq*0.58Nm/A",
                (column("Iq"), Quantity::Force, Kind::Rotary, 0.58),
            ),
            (
                "torque=Trq %*2.39mNm/%",
                (column("Trq %"), Quantity::Force, Kind::Rotary, 2.39e-3),
            ),
            (
                "position = a*b * 1e-3 mm",
                (column("a*b"), Quantity::Position, Kind::Linear, 1e-6),
            ),
            (
                "time=#1*ms",
                (column("#1"), Quantity::Time, Kind::Neither, 1e-3),
            ),
            (
                "force=F*-2kN",
                (column("F"), Quantity::Force, Kind::Linear, -2000.0),
            ),
            (
                "acceleration=a*1m/s²",
                (column("a"), Quantity::Acceleration, Kind::Linear, 1.0),
            ),
        ] {
            assert_eq!(read(text), expected, "{text}");
        }
        for (text, what) in [
            ("torque", "there is no ="),
            ("heat=T*1Nm", "heat is no quantity"),
            ("torque=Iq", "there is no factor with a unit"),
            ("torque=Iq*0Nm", "a factor of 0 leaves nothing"),
            ("torque=Iq*--1Nm", "--1 is no number"),
            (
                "torque=Iq*0.58",
                "nothing is none of its units: n, kn, nm, mnm",
            ),
            ("torque=Iq*0.58mm", "mm is none of its units"),
        ] {
            let trouble = text.parse::<MappedColumn>().unwrap_err();
            assert!(
                trouble.message.contains(what),
                "{text}: {}",
                trouble.message
            );
        }
    }

    #[test]
    fn a_column_is_found_by_name_or_number() {
        let names = ["Time".to_owned(), "Iq [A]".to_owned()];
        let index = |text: &str| text.parse::<MappedColumn>().unwrap().index(&names);
        assert_eq!(index("torque=iq*1Nm"), Ok(1));
        assert_eq!(index("torque=Iq [A]*1Nm"), Ok(1));
        assert_eq!(index("torque=#2*1Nm"), Ok(1));
        let trouble = index("torque=#3*1Nm").unwrap_err();
        assert_eq!(trouble.message, "--map: there is no column #3");
        assert_eq!(trouble.help, "the columns are: Time, Iq [A]");
    }
}
