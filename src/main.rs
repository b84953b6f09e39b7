//! gwatt on the command line.
fn main() {}
