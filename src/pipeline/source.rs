//! Programs and outputs of any type as one type each, so that what reads and writes them is
//! compiled once, in this library, and not for each type in each crate that calls it.

use std::io::{Read, Seek, Write};

use super::Restart;

/// A program.
pub(super) trait Source: Read + Seek + Send {}

impl<T: Read + Seek + Send> Source for T {}

/// What is written to.
pub(super) trait Target: Write + Restart + Send {}

impl<T: Write + Restart + Send> Target for T {}
