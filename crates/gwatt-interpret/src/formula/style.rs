//! Which language an expression is of.

/// The language of an expression.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Style {
    Isg,
    Osp,
}
