//! Offsets between program and machine: work coordinate systems, G52 and G92,
//! tool length, and what the program turns or scales.
//!
//! `LinuxCNC` keeps its offsets in the numbered parameters 5161 to 5390, in the
//! machine's own unit ("Parameters", "Coordinate Systems"). They are kept here
//! the same way, for every family: G54 to G59 are at the same numbers in Fanuc.

use crate::rules::rules_of;
use std::collections::BTreeMap;

use super::Reading;
use super::frame::{Affine, Frame};
use super::given::GivenVariable;
use super::parameter_file::ParameterFile;
use gwatt_machine::units::MM_PER_INCH;
use gwatt_machine::{AXES, AxisId, AxisKind, AxisSet, AxisValues, Machine};

/// First and last of the parameters that are kept.
pub(super) const FIRST: u32 = 5161;
pub(super) const LAST: u32 = 5390;
const COUNT: usize = (LAST - FIRST + 1) as usize;
/// First parameters of the points of G28 and G30.
pub(super) const REFERENCE: [u32; 2] = [5161, 5181];
/// Whether G92 is in force, and its first offset.
pub(super) const G92_ON: u32 = 5210;
pub(super) const G92: u32 = 5211;
/// Number of the coordinate system in force.
pub(super) const SYSTEM: u32 = 5220;
/// Axes that have parameters: XYZABCUVW.
pub(super) const PARAMETER_AXES: usize = 9;
/// Systems with parameters: G54 to G59.3.
pub(super) const SYSTEMS: u16 = 9;
/// Further systems (G54.1 P1 …) are numbered from here on, and how many exist.
pub(super) const FURTHER: u16 = 100;
pub(super) const FURTHER_MAX: u16 = 300;

/// All that stands between a program coordinate and a machine coordinate.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Offsets {
    stored: Box<[f64; COUNT]>,
    /// Which of them are known, and not taken as 0.
    has_value: [bool; COUNT],
    further: BTreeMap<u16, Further>,
    /// Millimetres in the machine's own unit.
    native_mm: f64,
    linear: AxisSet,
    /// The work coordinate system in force: its number, origin and turn.
    pub(super) system: u16,
    origin: AxisValues,
    rotation_deg: f64,
    /// Added to all work offsets (Fanuc's G10 L2 P0).
    pub(super) external: AxisValues,
    /// G92 in force (`LinuxCNC`: G52 too), and Fanuc's G52.
    pub(super) g92: AxisValues,
    pub(super) local: AxisValues,
    /// Tool length in force.
    pub(super) tool: AxisValues,
    /// Rotation, scaling and mirroring of the program.
    pub(super) programmed: Affine,
    /// A parameter file has given all offsets.
    pub(super) known: bool,
    /// Systems whose offsets the machine file gives, as bits.
    given: u16,
}

/// The offset of a further system.
#[derive(Debug, Clone, Default, PartialEq)]
struct Further {
    origin: AxisValues,
    /// Axes of which it is known, and not taken as 0.
    known: AxisSet,
}

/// First parameter of a work coordinate system.
fn first_of(system: u16) -> u32 {
    5201 + 20 * u32::from(system)
}

impl Offsets {
    pub(super) fn new(machine: &Machine, reading: &Reading) -> Self {
        let parameters = reading.parameters.as_deref();
        let linear = (0..AXES).filter(|&axis| {
            // Axes that the machine lacks are what their letters usually are.
            let rotary = [AxisId::A, AxisId::B, AxisId::C]
                .iter()
                .any(|id| *id as usize == axis);
            machine.axes[axis].map_or(!rotary, |data| data.kind == AxisKind::Linear)
        });
        let mut set = AxisSet::default();
        linear.for_each(|axis| set.insert(axis));
        let metric = machine.controller.language.metric;
        let stored = rules_of(&machine.controller.language).places_in_parameters;
        // LinuxCNC and grbl keep all of them there; what is missing is 0.
        let all_known = stored && parameters.is_some();
        let mut offsets = Self {
            stored: Box::new([0.0; COUNT]),
            has_value: [all_known; COUNT],
            further: BTreeMap::new(),
            native_mm: if metric { 1.0 } else { MM_PER_INCH },
            linear: set,
            system: 1,
            origin: [0.0; AXES],
            rotation_deg: 0.0,
            external: [0.0; AXES],
            g92: [0.0; AXES],
            local: [0.0; AXES],
            tool: [0.0; AXES],
            programmed: Affine::IDENTITY,
            known: all_known,
            given: 0,
        };
        offsets.set_stored(SYSTEM, 1.0);
        for (system, origin) in (1..).zip(&machine.offsets) {
            let Some(origin) = origin else { continue };
            for (axis, value_mm) in origin.iter().enumerate() {
                offsets.set_origin_of(system, axis, *value_mm);
            }
            offsets.given |= 1 << system;
        }
        for (number, origin) in &machine.further_offsets {
            for (axis, value_mm) in origin.iter().enumerate() {
                offsets.set_origin_of(FURTHER + number, axis, *value_mm);
            }
        }
        for (first, places) in REFERENCE.into_iter().zip(&machine.points) {
            for (axis, place) in places.iter().enumerate() {
                if let Some(place_mm) = place {
                    offsets.store_axis(first, axis, *place_mm);
                }
            }
        }
        for (number, value) in parameters.into_iter().flat_map(ParameterFile::iter) {
            offsets.set_stored(number, value);
        }
        for (number, value) in reading.given.iter().filter_map(GivenVariable::number) {
            if stored {
                offsets.set_stored(number, value);
            }
        }
        if (offsets.stored(G92_ON)).is_some_and(|on| on != 0.0) {
            offsets.g92 = offsets.axes_from(G92);
        }
        let system = offsets.stored(SYSTEM).unwrap_or(1.0);
        offsets.system = if (1.0..=f64::from(SYSTEMS)).contains(&system) {
            system as u16
        } else {
            1
        };
        offsets.load();
        offsets
    }

    /// A stored parameter, in the machine's unit.
    pub(super) fn stored(&self, number: u32) -> Option<f64> {
        let index = number.checked_sub(FIRST)?;
        self.stored.get(index as usize).copied()
    }

    /// The same where it is known, and not only taken as 0.
    pub(super) fn known(&self, number: u32) -> Option<f64> {
        let index = number.checked_sub(FIRST)?;
        let has_value = self.has_value.get(index as usize).copied()?;
        has_value.then(|| self.stored(number)).flatten()
    }

    /// Stores a parameter; false if it is none of those kept here.
    pub(super) fn set_stored(&mut self, number: u32, value: f64) -> bool {
        let index = number.wrapping_sub(FIRST) as usize;
        let (Some(slot), Some(has_value)) =
            (self.stored.get_mut(index), self.has_value.get_mut(index))
        else {
            return false;
        };
        (*slot, *has_value) = (value, true);
        true
    }

    /// Millimetres (degrees) in the machine's unit of an axis.
    pub(super) fn native(&self, axis: usize) -> f64 {
        if self.linear.contains(axis) {
            self.native_mm
        } else {
            1.0
        }
    }

    /// True for axes in mm, false for those in degrees.
    pub(super) fn is_linear(&self, axis: usize) -> bool {
        self.linear.contains(axis)
    }

    /// Values of all axes at `first` and the numbers after it, in mm.
    pub(super) fn axes_from(&self, first: u32) -> AxisValues {
        std::array::from_fn(|axis| {
            if axis >= PARAMETER_AXES {
                return 0.0;
            }
            let value = self.stored(first + axis as u32).unwrap_or(0.0);
            value * self.native(axis)
        })
    }

    /// The value of one axis at `first` and its number, in mm, where it is known.
    pub(super) fn known_from(&self, first: u32, axis: usize) -> Option<f64> {
        let value = (axis < PARAMETER_AXES).then(|| self.known(first + axis as u32))??;
        Some(value * self.native(axis))
    }

    /// Stores the value of one axis, in mm, at `first` and its number.
    pub(super) fn store_axis(&mut self, first: u32, axis: usize, value_mm: f64) {
        if axis < PARAMETER_AXES {
            let value = value_mm / self.native(axis);
            self.set_stored(first + axis as u32, value);
        }
    }

    /// The stored origin of a system, in mm.
    pub(super) fn origin_of(&self, system: u16) -> AxisValues {
        if (1..=SYSTEMS).contains(&system) {
            self.axes_from(first_of(system))
        } else {
            let further = self.further.get(&system);
            further.map_or([0.0; AXES], |further| further.origin)
        }
    }

    /// The stored turn of a system, degrees.
    pub(super) fn rotation_of(&self, system: u16) -> f64 {
        if (1..=SYSTEMS).contains(&system) {
            let number = first_of(system) + PARAMETER_AXES as u32;
            self.stored(number).unwrap_or(0.0)
        } else {
            0.0
        }
    }

    pub(super) fn set_rotation_of(&mut self, system: u16, angle_deg: f64) {
        if (1..=SYSTEMS).contains(&system) {
            self.set_stored(first_of(system) + PARAMETER_AXES as u32, angle_deg);
        }
    }

    /// Stores the origin of one axis of a system, in mm.
    pub(super) fn set_origin_of(&mut self, system: u16, axis: usize, value_mm: f64) {
        if (1..=SYSTEMS).contains(&system) {
            self.store_axis(first_of(system), axis, value_mm);
        } else if (FURTHER..=FURTHER + FURTHER_MAX).contains(&system) && axis < AXES {
            let further = self.further.entry(system).or_default();
            further.origin[axis] = value_mm;
            further.known.insert(axis);
        }
    }

    /// Selects a system. `LinuxCNC` does nothing if it is in force already,
    /// even if its parameters have been assigned since.
    pub(super) fn select(&mut self, system: u16) {
        if system != self.system {
            self.system = system;
            self.set_stored(SYSTEM, f64::from(system));
            self.load();
        }
    }

    /// Whether the offset of the system in force is known, not taken as 0.
    pub(super) fn is_known(&self) -> bool {
        let has = |axis| self.is_origin_known(self.system, axis);
        let given = self.system <= SYSTEMS && (self.known || self.given & 1 << self.system != 0);
        given || (0..AXES).any(has)
    }

    /// The same for one axis, whose offset the program may have set.
    pub(super) fn is_known_of(&self, axis: usize) -> bool {
        self.is_origin_known(self.system, axis)
    }

    /// Whether the origin of a system is known along an axis.
    pub(super) fn is_origin_known(&self, system: u16, axis: usize) -> bool {
        if (1..=SYSTEMS).contains(&system) {
            return self.known_from(first_of(system), axis).is_some();
        }
        let further = self.further.get(&system);
        further.is_some_and(|further| further.known.contains(axis))
    }

    /// The origin of a system along an axis rests on what is not known.
    pub(super) fn forget_origin(&mut self, system: u16, axis: usize) {
        if (1..=SYSTEMS).contains(&system) && axis < PARAMETER_AXES {
            let index = (first_of(system) - FIRST) as usize + axis;
            if let Some(has_value) = self.has_value.get_mut(index) {
                *has_value = false;
            }
        } else if let Some(further) = self.further.get_mut(&system) {
            further.known.0 &= !(1 << axis);
        }
    }

    /// Takes over what is stored for the system in force.
    pub(super) fn load(&mut self) {
        self.origin = self.origin_of(self.system);
        self.rotation_deg = self.rotation_of(self.system);
    }

    /// G52 of `LinuxCNC` and G92: the offset in force of one axis, stored too.
    pub(super) fn set_g92(&mut self, axis: usize, value_mm: f64) {
        self.g92[axis] = value_mm;
        self.set_stored(G92_ON, 1.0);
        // The other axes store what was in force, which need not be known.
        let has_value = self.has_value;
        let values = self.g92;
        for (axis, value) in values.into_iter().enumerate() {
            self.store_axis(G92, axis, value);
        }
        self.has_value = has_value;
        self.store_axis(G92, axis, value_mm);
    }

    /// G92.1 (`forget`) and G92.2.
    pub(super) fn clear_g92(&mut self, forget: bool) {
        self.g92 = [0.0; AXES];
        self.set_stored(G92_ON, 0.0);
        for axis in 0..PARAMETER_AXES * usize::from(forget) {
            self.store_axis(G92, axis, 0.0);
        }
    }

    /// Whether it is known what G92 has stored for an axis.
    pub(super) fn is_g92_told(&self, axis: usize) -> bool {
        axis >= PARAMETER_AXES || self.known(G92 + axis as u32).is_some()
    }

    /// G92.3.
    pub(super) fn restore_g92(&mut self) {
        self.set_stored(G92_ON, 1.0);
        self.g92 = self.axes_from(G92);
    }

    /// The map that all of this makes: the offsets of G92 and G52 lie within
    /// the turned system, origin and tool outside of it.
    pub(super) fn frame(&self) -> Frame {
        let within = self.within(&self.origin, self.rotation_deg, true);
        Frame::new(&within.0, within.1)
    }

    /// The map under another system, without the tool length if so wanted.
    pub(super) fn frame_of(&self, system: u16, with_tool: bool) -> Frame {
        let origin = self.origin_of(system);
        let within = self.within(&origin, self.rotation_of(system), with_tool);
        Frame::new(&within.0, within.1)
    }

    fn within(&self, origin: &AxisValues, angle: f64, with_tool: bool) -> (Affine, AxisValues) {
        let inner: AxisValues = std::array::from_fn(|axis| self.g92[axis] + self.local[axis]);
        let mut outer: AxisValues = std::array::from_fn(|axis| {
            let tool = if with_tool { self.tool[axis] } else { 0.0 };
            origin[axis] + self.external[axis] + tool
        });
        for axis in super::frame::SPACE..AXES {
            outer[axis] += inner[axis];
        }
        let offset = Affine::offset([inner[0], inner[1], inner[2]]);
        let turned = Affine::rotation([0, 1], [0.0; 2], angle);
        (self.programmed.then(&offset).then(&turned), outer)
    }
}
