//! Random numbers for tests that failures can be repeated with.

/// A small generator (xorshift64*), begun by any number but 0.
pub(crate) struct Random(pub u64);

impl Random {
    /// The next number, from 0 to below 1.
    pub fn next(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 11) as f64 / (1_u64 << 53) as f64
    }
}
