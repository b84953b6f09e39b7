//! Tool tables as `LinuxCNC` writes them ("Tool Table").
//!
//! One tool in a line: `T1 P1 D.. Z.. X.. I.. J.. Q.. ;comment`, in any order.

use gwatt_machine::{ALL_AXES, AXES, AxisValues};
use gwatt_syntax::diagnostic::Diagnostic;
use gwatt_syntax::source::{Span, lines};

/// Tools that are read at most; `LinuxCNC` takes 1000.
const TOOLS_MAX: usize = 100_000;

/// A tool. Lengths are in the machine's own unit.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Tool {
    /// T: its number.
    pub number: u32,
    /// P: its pocket.
    pub pocket: u32,
    /// Offset of each axis.
    pub offsets: AxisValues,
    /// D: its diameter.
    pub diameter: f64,
    /// I: angle of its front edge, degrees.
    pub front_angle: f64,
    /// J: angle of its back edge, degrees.
    pub back_angle: f64,
    /// Q: orientation of a turning tool, 0 to 9.
    pub orientation: u8,
}

/// The tools of a machine, by number.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ToolTable {
    /// Sorted by number.
    tools: Vec<Tool>,
}

impl ToolTable {
    /// Reads a tool table.
    ///
    /// # Errors
    ///
    /// What is wrong, line by line.
    pub fn parse(bytes: &[u8]) -> Result<Self, Vec<Diagnostic>> {
        let mut table = Self::default();
        let mut errors = Vec::new();
        for (text, number) in lines(bytes).zip(1..) {
            let line = Line { text, number };
            match line.tool() {
                Ok(Some(tool)) => {
                    if let Err(error) = table.add(tool, &line) {
                        errors.push(*error);
                    }
                }
                Ok(None) => {}
                Err(error) => errors.push(*error),
            }
            if errors.len() >= 50 {
                break;
            }
        }
        if errors.is_empty() {
            Ok(table)
        } else {
            Err(errors)
        }
    }

    /// The tool with this number.
    #[must_use]
    pub fn find(&self, number: u32) -> Option<&Tool> {
        let index = self.tools.binary_search_by_key(&number, |tool| tool.number);
        self.tools.get(index.ok()?)
    }

    fn add(&mut self, tool: Tool, line: &Line<'_>) -> Result<(), Box<Diagnostic>> {
        let all = Span::new(0, line.text.len());
        // Most tables are sorted, so this mostly appends.
        let at = self
            .tools
            .partition_point(|other| other.number < tool.number);
        if self
            .tools
            .get(at)
            .is_some_and(|other| other.number == tool.number)
        {
            let message = format!("tool {} is in the table twice", tool.number);
            return Err(line.error(message, all, "keep one of the lines"));
        }
        if self.tools.len() >= TOOLS_MAX {
            let message = format!("more than {TOOLS_MAX} tools");
            return Err(line.error(message, all, "give a table of one machine"));
        }
        self.tools.insert(at, tool);
        Ok(())
    }
}

/// A line of the table.
struct Line<'a> {
    text: &'a [u8],
    number: u64,
}

impl Line<'_> {
    fn error(&self, message: impl Into<String>, span: Span, help: &str) -> Box<Diagnostic> {
        let found = Diagnostic::error("tool-table", message).at(self.number, span, self.text);
        Box::new(found.help(help))
    }

    /// The tool of the line; `None` for one that is empty or a comment.
    fn tool(&self) -> Result<Option<Tool>, Box<Diagnostic>> {
        let mut tool = Tool::default();
        let mut given = 0_u32;
        for span in words(self.text) {
            let word = span.of(self.text);
            let letter = word.first().map_or(0, u8::to_ascii_uppercase);
            let value = std::str::from_utf8(word.get(1..).unwrap_or_default())
                .ok()
                .and_then(|text| text.parse::<f64>().ok())
                .filter(|value| value.is_finite());
            let (true, Some(value)) = (letter.is_ascii_uppercase(), value) else {
                let help = "write tools as in `T1 P1 D3.0 Z+11.0 ;comment`";
                return Err(self.error("this is not a letter with its number", span, help));
            };
            let bit = 1 << (letter - b'A');
            if given & bit != 0 {
                let message = format!("{} is given twice", letter as char);
                return Err(self.error(message, span, "keep one of them"));
            }
            given |= bit;
            if !tool.set(letter, value) {
                let help = "T and P are whole numbers from 0, Q is one from 0 to 9, \
                            and the others are D, I, J and the axes X Y Z A B C U V W";
                let message = format!("{} cannot be this", letter as char);
                return Err(self.error(message, span, help));
            }
        }
        if given == 0 {
            return Ok(None);
        }
        if given & 1 << (b'T' - b'A') == 0 {
            let all = Span::new(0, self.text.len());
            let help = "write it as T and a number";
            return Err(self.error("a tool without its number", all, help));
        }
        Ok(Some(tool))
    }
}

impl Tool {
    /// Takes a word; false when the tool cannot have it.
    fn set(&mut self, letter: u8, value: f64) -> bool {
        let whole = value.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&value);
        match letter {
            b'T' if whole => self.number = value as u32,
            b'P' if whole => self.pocket = value as u32,
            b'Q' if whole && value <= 9.0 => self.orientation = value as u8,
            b'D' => self.diameter = value,
            b'I' => self.front_angle = value,
            b'J' => self.back_angle = value,
            _ => {
                let axis = (0..AXES - 1).find(|&axis| ALL_AXES[axis].letter() == letter);
                let slot = axis.and_then(|axis| self.offsets.get_mut(axis));
                match slot {
                    Some(slot) => *slot = value,
                    None => return false,
                }
            }
        }
        true
    }
}

/// The words of a line: what stands between blanks, up to a `;`.
pub(super) fn words(text: &[u8]) -> impl Iterator<Item = Span> {
    let end = text.iter().position(|byte| *byte == b';');
    let text = text.get(..end.unwrap_or(text.len())).unwrap_or_default();
    let mut at = 0;
    std::iter::from_fn(move || {
        let rest = text.get(at..)?;
        let start = at + rest.iter().position(|byte| !byte.is_ascii_whitespace())?;
        let rest = text.get(start..)?;
        let length = rest.iter().position(u8::is_ascii_whitespace);
        at = start + length.unwrap_or(rest.len());
        Some(Span::new(start, at))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_word_of_a_tool() {
        let text = b";head\nT3 P1 D0.5 X-1 Z+11.25 W2 I95 J155 Q1 ;note T4\r\n\nt1 p2\n";
        let table = ToolTable::parse(text).unwrap();
        let tool = table.find(3).unwrap();
        assert_eq!((tool.pocket, tool.orientation), (1, 1));
        assert_eq!([tool.offsets[0], tool.offsets[2]], [-1.0, 11.25]);
        assert_eq!([tool.offsets[8], tool.diameter], [2.0, 0.5]);
        assert_eq!([tool.front_angle, tool.back_angle], [95.0, 155.0]);
        assert_eq!(table.find(1).unwrap().pocket, 2);
        assert_eq!(table.find(2), None);
    }

    fn error(text: &str) -> String {
        let errors = ToolTable::parse(text.as_bytes()).unwrap_err();
        let found = errors.first().unwrap();
        let span = (found.span.start, found.span.end);
        format!("{}:{span:?} {}", found.line, found.message)
    }

    #[test]
    fn each_error_once() {
        assert_eq!(
            error("T1\n  1 2 3\n"),
            "2:(2, 3) this is not a letter with its number"
        );
        assert_eq!(
            error("T1 Zfoo"),
            "1:(3, 7) this is not a letter with its number"
        );
        assert_eq!(error("T1 Z1 Z2"), "1:(6, 8) Z is given twice");
        assert_eq!(error("T1.5 Z1"), "1:(0, 4) T cannot be this");
        assert_eq!(error("T1 Q10"), "1:(3, 6) Q cannot be this");
        assert_eq!(error("T1 E1"), "1:(3, 5) E cannot be this");
        assert_eq!(error("P1 Z1"), "1:(0, 5) a tool without its number");
        assert_eq!(
            error("T1\nT2\nT1 Z5"),
            "3:(0, 5) tool 1 is in the table twice"
        );
        assert_eq!(
            error("T1 Znan"),
            "1:(3, 7) this is not a letter with its number"
        );
    }
}
