//! What the language of a program keeps from block to block, besides what all keep.

use super::isg::Isg;
use super::nci::Nci;
use super::osp::Osp;
use super::siemens::Siemens;

/// The state that only one language has.
#[derive(Debug, Default)]
pub(super) enum OwnState {
    /// All that it keeps others keep as well; or it is lent out for the time being.
    #[default]
    None,
    Siemens(Box<Siemens>),
    Isg(Box<Isg>),
    Osp(Box<Osp>),
    Nci(Nci),
}

impl OwnState {
    /// SINUMERIK's.
    pub(super) fn siemens(&self) -> Option<&Siemens> {
        match self {
            Self::Siemens(state) => Some(state),
            _ => None,
        }
    }

    /// SINUMERIK's, lent out until it is put back.
    pub(super) fn take_siemens(&mut self) -> Option<Box<Siemens>> {
        match std::mem::take(self) {
            Self::Siemens(state) => Some(state),
            other => {
                *self = other;
                None
            }
        }
    }

    /// That of the ISG kernel, lent out until it is put back.
    pub(super) fn take_isg(&mut self) -> Option<Box<Isg>> {
        match std::mem::take(self) {
            Self::Isg(state) => Some(state),
            other => {
                *self = other;
                None
            }
        }
    }
}
