//! What is left of a line.

/// The rest of a line, without blanks before it.
pub(super) struct Rest<'t>(pub(super) &'t [u8]);

impl Rest<'_> {
    pub(super) fn skip(&mut self, count: usize) {
        self.0 = self.0.get(count..).unwrap_or_default().trim_ascii_start();
    }

    /// Takes bytes for which `inside` holds, upper case.
    pub(super) fn run(&mut self, inside: impl Fn(&u8) -> bool) -> String {
        let text = self.0.trim_ascii_end();
        let length = text.iter().take_while(|byte| inside(byte)).count();
        let taken = String::from_utf8_lossy(text.get(..length).unwrap_or_default());
        let taken = taken.to_ascii_uppercase();
        self.skip(length);
        taken
    }

    pub(super) fn digits(&mut self) -> String {
        self.run(u8::is_ascii_digit)
    }

    pub(super) fn comment(&mut self) {
        while self.0.starts_with(b"(") {
            let end = memchr::memchr(b')', self.0).unwrap_or(self.0.len());
            self.skip(end + 1);
        }
    }

    pub(super) fn byte_order_mark(&mut self) {
        self.0 = self.0.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(self.0);
    }

    pub(super) fn block_delete(&mut self) {
        if self.0.starts_with(b"/") {
            self.skip(1);
            self.digits();
        }
    }

    /// A block number after one of these signs, as `N10`.
    pub(super) fn block_number(&mut self, signs: &[u8]) -> Option<String> {
        let before = self.0;
        if !self.0.first().is_some_and(|byte| signs.contains(byte)) {
            return None;
        }
        self.skip(1);
        let number = self.digits().parse::<u64>().ok();
        if number.is_none() {
            self.0 = before;
        }
        number.map(|number| format!("N{number}"))
    }

    /// A name, upper case; empty where none is next.
    pub(super) fn name(&mut self) -> String {
        let begins = |byte: &u8| byte.is_ascii_alphabetic() || *byte == b'_';
        if !self.0.first().is_some_and(begins) {
            return String::new();
        }
        self.run(|byte| byte.is_ascii_alphanumeric() || *byte == b'_')
    }
}
