//! Sums and products as `Configuration.h` has them: `(50*60)`, `X_BED_SIZE - 10`.

/// More steps are no setting.
const STEPS: u32 = 200;

/// The value of an expression; `name` gives that of a name. `None` where it is none.
pub(crate) fn value(
    text: &str,
    name: &dyn Fn(&str, u32) -> Option<f64>,
    depth: u32,
) -> Option<f64> {
    let mut reader = Reader {
        rest: text.trim(),
        name,
        depth,
        steps: 0,
    };
    let value = reader.sum()?;
    (reader.rest.is_empty() && value.is_finite()).then_some(value)
}

struct Reader<'t, 'n> {
    rest: &'t str,
    name: &'n dyn Fn(&str, u32) -> Option<f64>,
    depth: u32,
    steps: u32,
}

impl Reader<'_, '_> {
    fn sum(&mut self) -> Option<f64> {
        let mut value = self.product()?;
        loop {
            if self.eats('+') {
                value += self.product()?;
            } else if self.eats('-') {
                value -= self.product()?;
            } else {
                return Some(value);
            }
        }
    }

    fn product(&mut self) -> Option<f64> {
        let mut value = self.factor()?;
        loop {
            if self.eats('*') {
                value *= self.factor()?;
            } else if self.eats('/') {
                value /= self.factor()?;
            } else {
                return Some(value);
            }
        }
    }

    fn factor(&mut self) -> Option<f64> {
        self.steps += 1;
        if self.steps > STEPS {
            return None;
        }
        if self.eats('-') {
            return Some(-self.factor()?);
        }
        if self.eats('+') {
            return self.factor();
        }
        if self.eats('(') {
            let value = self.sum()?;
            return self.eats(')').then_some(value);
        }
        let end = self.word();
        let (word, rest) = self.rest.split_at_checked(end)?;
        self.rest = rest.trim_start();
        if word.starts_with(|c: char| c.is_ascii_digit() || c == '.') {
            word.trim_end_matches(['f', 'F', 'u', 'U', 'l', 'L'])
                .parse()
                .ok()
        } else if word.is_empty() {
            None
        } else {
            (self.name)(word, self.depth + 1)
        }
    }

    /// The length of a number or a name.
    fn word(&self) -> usize {
        let number = self
            .rest
            .starts_with(|c: char| c.is_ascii_digit() || c == '.');
        let mut before = ' ';
        for (at, c) in self.rest.char_indices() {
            let exponent = number && matches!(c, '+' | '-') && matches!(before, 'e' | 'E');
            if !(c.is_ascii_alphanumeric() || c == '_' || c == '.' || exponent) {
                return at;
            }
            before = c;
        }
        self.rest.len()
    }

    fn eats(&mut self, wanted: char) -> bool {
        match self.rest.strip_prefix(wanted) {
            Some(rest) => {
                self.rest = rest.trim_start();
                true
            }
            None => false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::value;

    fn of(text: &str) -> Option<f64> {
        value(text, &|name, _| (name == "SIZE").then_some(200.0), 0)
    }

    #[test]
    fn sums_and_products() {
        assert_eq!(of("(50*60)"), Some(3000.0));
        assert_eq!(of("SIZE - 10/4"), Some(197.5));
        assert_eq!(of("-(2+3)*2.5f"), Some(-12.5));
        assert_eq!(of("1e3"), Some(1000.0));
    }

    #[test]
    fn what_is_none() {
        for text in ["", "2*", "(2", "NAME", "1/0", "2)", "two", "ä", "- - -"] {
            assert_eq!(of(text), None, "{text}");
        }
        assert_eq!(of(&"(".repeat(10_000)), None);
        assert_eq!(of(&"-".repeat(10_000)), None);
    }
}
