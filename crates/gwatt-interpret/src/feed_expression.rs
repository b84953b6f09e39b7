//! What the F in force was worked out from. It is kept with the F as long as it has the same
//! value, so that a later block can be given the F by it, whichever value it has in a run.

use super::control::Control;
use super::modal::{Feed, NumberText};
use gwatt_syntax::Word;

/// What stands after the letter of a word, with the `=` where the language has one.
pub(super) fn expression_of(word: Word, text: &[u8]) -> NumberText {
    let from = word.span.start as usize + 1;
    let after_letter = text.get(from..word.number.start as usize);
    let number = word.number.of(text);
    if !after_letter.is_some_and(|between| between.contains(&b'=')) {
        return NumberText::new(number.trim_ascii());
    }
    let mut whole = vec![b'='];
    whole.extend_from_slice(number.trim_ascii());
    NumberText::new(&whole)
}

impl Control<'_> {
    /// After a block: what the F in force was worked out from is kept as long as it has the
    /// value of that F.
    #[inline]
    pub(super) fn check_expression(&mut self) {
        let feed = self.modal.feed.as_ref();
        if feed.is_some_and(|feed| !feed.expression.as_bytes().is_empty()) {
            self.compare_expression();
        }
    }

    #[cold]
    fn compare_expression(&mut self) {
        let Some(Feed {
            value, expression, ..
        }) = self.modal.feed
        else {
            return;
        };
        let text = expression.as_bytes();
        if self
            .language
            .value(self, text.strip_prefix(b"=").unwrap_or(text))
            != Some(value)
            && let Some(feed) = &mut self.modal.feed
        {
            feed.expression = NumberText::default();
        }
    }
}
