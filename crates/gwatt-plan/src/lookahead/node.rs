//! Joints between blocks, and the spans between them.

use super::super::s_curve::Steepness;
use super::super::section::Section;

/// Squared speeds and accelerations beyond this (a million km/s) are no limits;
/// sums with it stay finite.
pub(super) const UNLIMITED: f64 = 1e24;

/// Elements that are not final, at most; beyond it the older half is released
/// as if the path ended here, and marked as not certain.
pub(super) const OPEN_MAX: usize = 1 << 14;

/// A path element as the passes see it.
#[derive(Debug, Clone)]
pub(super) struct Node<P> {
    /// Length in mm.
    pub length: f64,
    /// Largest speed inside, squared.
    pub top2: f64,
    /// The same as it is seen from the element before it, squared.
    pub seen2: f64,
    /// Acceleration along it.
    pub accel: f64,
    /// Jerk along it; infinite: no limit.
    pub jerk: f64,
    /// Acceleration of the smoothed pass; see `cruise`.
    pub smooth_accel: f64,
    /// Largest squared speed at its start.
    pub entry2: f64,
    /// Squared speed at which it begins where what is before it ends at rest.
    pub step2: f64,
    /// Squared speed at which it begins though what is before it is slower; mostly 0.
    pub begins2: f64,
    /// Squared speed at which it may be left while nothing waits after it.
    pub exit2: f64,
    /// False for a blend, which enters the controller's queue together with
    /// the block after it.
    pub block: bool,
    /// It may be entered faster than its own speed, to which it then brakes.
    pub overruns: bool,
    /// What the caller wants back.
    pub payload: P,
    /// Planned speed at its start, squared.
    pub(crate) e2: f64,
    /// Sum of 2·a·L of all before it.
    pub(crate) sum: f64,
    /// Runs of motion before it.
    pub(crate) run: u32,
    /// Smoothed: largest and planned speed at its start, and cap of the hill.
    pub(crate) smooth_entry2: f64,
    pub(crate) hill2: f64,
    /// Released by the count, not by its neighbours.
    pub(crate) forced: bool,
}

impl<P> Node<P> {
    /// A node; speeds and lengths as in the fields.
    pub fn new(length: f64, top2: f64, accel: f64, entry2: f64, payload: P) -> Self {
        let accel = lower(accel, UNLIMITED);
        Self {
            length,
            top2: lower(top2, UNLIMITED),
            seen2: lower(top2, UNLIMITED),
            accel,
            jerk: f64::INFINITY,
            smooth_accel: accel,
            entry2,
            step2: 0.0,
            begins2: 0.0,
            exit2: 0.0,
            block: true,
            overruns: false,
            payload,
            e2: 0.0,
            sum: 0.0,
            run: 0,
            smooth_entry2: 0.0,
            hill2: f64::INFINITY,
            forced: false,
        }
    }

    /// By how much the squared speed changes along it at most.
    #[inline]
    pub fn ramp2(&self) -> f64 {
        2.0 * self.accel * self.length
    }

    /// The limits of its ramps.
    #[inline]
    pub fn steepness(&self) -> Steepness {
        Steepness {
            accel_mm_s2: self.accel,
            jerk_mm_s3: self.jerk,
        }
    }

    #[inline]
    pub(super) fn smooth2(&self) -> f64 {
        2.0 * self.smooth_accel * self.length
    }
}

/// The speeds of one element, squared, and the element itself.
#[derive(Debug)]
pub(super) struct Span<P> {
    pub start2: f64,
    pub end2: f64,
    /// Below the one at its start where it brakes to it first.
    pub top2: f64,
    pub length: f64,
    pub accel: f64,
    /// False where the count limit cut the look-ahead short.
    pub certain: bool,
    /// It may run slower, and be sped up and braked at any lower speed, as how many blocks the
    /// controller sees is a matter of timing.
    pub ranged: bool,
    /// Its part of an S-curve, where jerk is limited.
    pub section: Option<Section>,
    pub payload: P,
}

/// The lower of two numbers.
#[inline]
pub(super) fn lower(a: f64, b: f64) -> f64 {
    if b < a { b } else { a }
}
