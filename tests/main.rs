//! Tests.
mod machine;
