//! A transfer function as sections in series, and its exact samples when the
//! input is held between them (zero-order hold).
//!
//! Each section has at most two poles, so that no coefficient of a high power
//! is ever formed. A delay of a fraction of a period splits the hold in two:
//! `x(k+1) = Φ·x(k) + Γ₁·u(k−d−1) + Γ₀·u(k−d)` (Åström & Wittenmark,
//! *Computer-Controlled Systems*, 3rd ed., section 2.3).

use nalgebra::{DMatrix, DVector};

use super::transfer::{Factor, TransferFunction};

/// What of the output is measured. The differences of a speed or position are
/// modelled as they are, not as accelerations at a point in time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Measured {
    /// The output itself, at the sampling instant.
    Direct,
    /// The output's integral: `(v(k) − v(k−1))/T` is compared.
    Velocity,
    /// Its double integral: `(p(k) − 2·p(k−1) + p(k−2))/T²` is compared.
    Position,
}

impl Measured {
    /// How often it has been integrated.
    #[must_use]
    pub(super) fn integrators(self) -> usize {
        match self {
            Self::Direct => 0,
            Self::Velocity => 1,
            Self::Position => 2,
        }
    }
}

/// A continuous system `x' = A·x + B·u`, `y = C·x + D·u`.
#[derive(Debug, Clone)]
struct Continuous {
    a: DMatrix<f64>,
    b: DVector<f64>,
    c: DVector<f64>,
    d: f64,
}

/// A section: numerator of degree up to that of the denominator.
type Section = (Vec<f64>, Factor);

/// Shares the zeros among the poles; `None` if there are more zeros than
/// poles.
fn sections(transfer: &TransferFunction) -> Option<Vec<Section>> {
    let mut sections: Vec<Section> = transfer
        .poles
        .iter()
        .map(|pole| (vec![1.0], *pole))
        .collect();
    // Pairs first: they need a whole section of two poles.
    let mut numerators: Vec<Vec<f64>> = transfer.zeros.iter().map(|z| z.coefficients()).collect();
    numerators.sort_by_key(|p| std::cmp::Reverse(p.len()));
    for numerator in numerators {
        let need = numerator.len() - 1;
        let slot = sections
            .iter_mut()
            .filter(|(have, pole)| have.len() - 1 + need <= pole.degree())
            .min_by_key(|(have, pole)| pole.degree() - (have.len() - 1))?;
        slot.0 = super::polynomial::product(&slot.0, &numerator);
    }
    Some(sections)
}

impl Continuous {
    /// Sections in series, the gain first; `integrators` after.
    fn new(transfer: &TransferFunction, integrators: usize) -> Option<Self> {
        let sections = sections(transfer)?;
        let n = transfer.order() + integrators;
        let mut system = Self {
            a: DMatrix::zeros(n, n),
            b: DVector::zeros(n),
            c: DVector::zeros(n),
            d: transfer.gain,
        };
        // `c`, `d`: what reaches the next section, from the states so far.
        let mut at = 0;
        for (numerator, pole) in &sections {
            system.append(&mut at, numerator, *pole);
        }
        for _ in 0..integrators {
            let (c, d) = (system.c.clone(), system.d);
            system.a.row_mut(at).copy_from(&c.transpose());
            system.b[at] = d;
            system.c.fill(0.0);
            system.c[at] = 1.0;
            system.d = 0.0;
            at += 1;
        }
        Some(system)
    }

    /// Puts one section after the system.
    fn append(&mut self, at: &mut usize, numerator: &[f64], pole: Factor) {
        let i = *at;
        let n = |power: usize| numerator.get(power).copied().unwrap_or(0.0);
        let (c, d) = (self.c.transpose(), self.d);
        match pole {
            Factor::Real { time_constant_s } => {
                // x' = (w − x)/τ, out = direct·w + (1 − direct)·x
                let rate = 1.0 / time_constant_s;
                let direct = n(1) * rate;
                self.a.row_mut(i).copy_from(&(&c * rate));
                self.a[(i, i)] = -rate;
                self.b[i] = d * rate;
                self.c *= direct;
                self.c[i] = n(0) - direct;
                self.d *= direct;
                *at += 1;
            }
            Factor::Pair {
                omega_rad_s: w,
                damping,
            } => {
                // x₁' = ω·x₂, x₂' = ω·(in − x₁ − 2ζ·x₂): x₁ is the low-pass,
                // x₂·ω its derivative.
                let direct = n(2) * w * w;
                self.a.row_mut(i + 1).copy_from(&(&c * w));
                self.a[(i, i + 1)] = w;
                self.a[(i + 1, i)] = -w;
                self.a[(i + 1, i + 1)] = -2.0 * damping * w;
                self.b[i + 1] = d * w;
                self.c *= direct;
                self.c[i] = n(0) - direct;
                self.c[i + 1] = n(1) * w - 2.0 * damping * direct;
                self.d *= direct;
                *at += 2;
            }
        }
    }
}

/// A system sampled every `period_s`, its input held.
#[derive(Debug, Clone)]
pub struct Sampled {
    phi: Vec<f64>,
    now: Vec<f64>,
    before: Vec<f64>,
    c: Vec<f64>,
    d: f64,
    /// Whole periods of delay.
    lag: usize,
    /// Whether the direct path sees the input of the period before.
    direct_is_late: bool,
    measured: Measured,
    period_s: f64,
    order: usize,
}

impl Sampled {
    /// Samples a transfer function. `None` if it has more zeros than poles, or
    /// is not finite.
    #[must_use]
    pub fn new(transfer: &TransferFunction, measured: Measured, period_s: f64) -> Option<Self> {
        let integrators = measured.integrators();
        let system = Continuous::new(transfer, integrators)?;
        let n = system.b.len();
        let periods = (transfer.delay_s / period_s).max(0.0);
        // Closer than this to a sampling instant counts as on it.
        let lag = libm::floor(periods + 1e-9);
        let fraction = (periods - lag).max(0.0);
        let late = if fraction > 1e-9 { fraction } else { 0.0 };
        let (phi, whole) = hold(&system, period_s)?;
        let (now, before) = if late > 0.0 {
            // Over the last (1−f)·T the new value acts, over the first f·T the
            // old one, which then still swings for (1−f)·T.
            let (rest, now) = hold(&system, period_s * (1.0 - late))?;
            let (_, first) = hold(&system, period_s * late)?;
            (now, rest * first)
        } else {
            (whole, DVector::zeros(n))
        };
        Some(Self {
            phi: phi.transpose().as_slice().to_vec(),
            now: now.as_slice().to_vec(),
            before: before.as_slice().to_vec(),
            c: system.c.as_slice().to_vec(),
            d: system.d,
            lag: lag as usize,
            direct_is_late: late > 0.0,
            measured,
            period_s,
            order: n,
        })
    }

    /// Number of states.
    #[must_use]
    pub fn order(&self) -> usize {
        self.order
    }

    /// Whole periods of delay.
    #[must_use]
    pub(super) fn lag(&self) -> usize {
        self.lag
    }

    /// By how much an input that is held changes the measured output at the next sample.
    #[must_use]
    pub(super) fn at_once(&self) -> f64 {
        let moved: f64 = self.c.iter().zip(&self.now).map(|(c, x)| c * x).sum();
        let powers = i32::try_from(self.measured.integrators()).unwrap_or_default();
        moved / self.period_s.powi(powers)
    }
}

/// `e^(A·t)` and `∫₀ᵗ e^(A·s) ds · B`.
fn hold(system: &Continuous, t: f64) -> Option<(DMatrix<f64>, DVector<f64>)> {
    let n = system.b.len();
    let mut joined = DMatrix::zeros(n + 1, n + 1);
    joined.view_mut((0, 0), (n, n)).copy_from(&(&system.a * t));
    joined.view_mut((0, n), (n, 1)).copy_from(&(&system.b * t));
    let e = exponential(&joined)?;
    Some((
        e.view((0, 0), (n, n)).into_owned(),
        DVector::from_column_slice(e.view((0, n), (n, 1)).into_owned().as_slice()),
    ))
}

/// The exponential of a matrix: Taylor's series of the matrix halved until it
/// is small, squared as often. `None` if it is not finite.
#[must_use]
pub fn exponential(m: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    const TERMS: i32 = 14;
    const HALVINGS_MAX: u32 = 60;
    let mut size = m
        .row_iter()
        .map(|row| row.iter().map(|x| x.abs()).sum::<f64>())
        .fold(0.0, f64::max);
    if !size.is_finite() {
        return None;
    }
    let mut halvings = 0;
    while size > 0.25 && halvings < HALVINGS_MAX {
        size /= 2.0;
        halvings += 1;
    }
    let n = m.nrows();
    let small = m * (1.0 / (1_u64 << halvings) as f64);
    let mut sum = DMatrix::identity(n, n);
    let mut term = DMatrix::identity(n, n);
    for k in 1..=TERMS {
        term = &term * &small / f64::from(k);
        sum += &term;
    }
    for _ in 0..halvings {
        sum = &sum * &sum;
    }
    sum.iter().all(|x| x.is_finite()).then_some(sum)
}

/// A sampled system at work: keeps its state from one stretch of input to the
/// next.
#[derive(Debug, Clone)]
pub struct Simulation {
    system: Sampled,
    state: Vec<f64>,
    next: Vec<f64>,
    /// The last two outputs, for differences.
    last: [f64; 2],
    seen: usize,
}

impl Simulation {
    /// At rest.
    #[must_use]
    pub fn new(system: Sampled) -> Self {
        let n = system.order;
        Self {
            system,
            state: vec![0.0; n],
            next: vec![0.0; n],
            last: [0.0; 2],
            seen: 0,
        }
    }

    /// Output at sample `k` of `input`, which must be called for ascending k
    /// without gaps; before the first sample the input was that of `k` = 0 kept
    /// at zero.
    pub fn step(&mut self, input: &[f64], k: usize) -> f64 {
        let system = &self.system;
        let at = |back: usize| {
            k.checked_sub(system.lag + back)
                .and_then(|index| input.get(index))
                .copied()
                .unwrap_or(0.0)
        };
        self.advance(at(0), at(1))
    }

    /// Output at the next sample, where the input after the delay is `u`, and was `u_before`.
    pub(super) fn advance(&mut self, u: f64, u_before: f64) -> f64 {
        let system = &self.system;
        let direct = if system.direct_is_late { u_before } else { u };
        let y = system.d * direct + self.swung();
        for (i, row) in system.phi.chunks_exact(system.order.max(1)).enumerate() {
            let mut sum = 0.0;
            for (p, x) in row.iter().zip(&self.state) {
                sum += p * x;
            }
            let forced = system.now.get(i).copied().unwrap_or(0.0) * u
                + system.before.get(i).copied().unwrap_or(0.0) * u_before;
            if let Some(slot) = self.next.get_mut(i) {
                *slot = sum + forced;
            }
        }
        std::mem::swap(&mut self.state, &mut self.next);
        let difference = self.difference(y);
        self.last = [y, self.last[0]];
        let needed = self.system.measured.integrators();
        self.seen = self.seen.saturating_add(1);
        if self.seen > needed { difference } else { 0.0 }
    }

    /// What the states make of the output.
    fn swung(&self) -> f64 {
        let pairs = self.system.c.iter().zip(&self.state);
        pairs.map(|(c, x)| c * x).sum()
    }

    fn difference(&self, y: f64) -> f64 {
        let [before, earlier] = self.last;
        let t = self.system.period_s;
        match self.system.measured {
            Measured::Direct => y,
            Measured::Velocity => (y - before) / t,
            Measured::Position => (y - 2.0 * before + earlier) / (t * t),
        }
    }

    /// Output at the next sample of a system from rest that does not see its input at once.
    pub(super) fn foreseen(&self) -> f64 {
        self.difference(self.swung())
    }

    /// As if the input since the sample before had been so much more.
    pub(super) fn add(&mut self, more: f64) {
        for (state, now) in self.state.iter_mut().zip(&self.system.now) {
            *state += now * more;
        }
    }
}

/// The response of a transfer function to samples of a held input, from rest.
/// `None` if it has more zeros than poles, or is not finite.
#[must_use]
pub fn simulate(
    transfer: &TransferFunction,
    measured: Measured,
    period_s: f64,
    input: &[f64],
) -> Option<Vec<f64>> {
    let mut simulation = Simulation::new(Sampled::new(transfer, measured, period_s)?);
    Some(
        (0..input.len())
            .map(|k| simulation.step(input, k))
            .collect(),
    )
}
