//! The examples of README.md show what gwatt prints.

#[test]
fn examples_are_true() {
    trycmd::TestCases::new().case("README.md");
}
