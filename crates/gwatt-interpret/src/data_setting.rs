//! G10: the program sets offsets and tools ("G10 L1", "L2", "L10", "L11" and
//! "L20" of `LinuxCNC`; Fanuc "Programmable Data Input (G10)").

use super::control::{Control, Run};
use super::frame::Affine;
use super::offsets::{FURTHER, FURTHER_MAX, SYSTEMS};
use super::places::POSITION_MAX_MM;
use super::tool_table::Tool;
use super::tools::words::tool_number;
use arrayvec::ArrayVec;
use gwatt_machine::{ALL_AXES, AXES, AxisValues};
use gwatt_syntax::source::Span;

/// The system that G10 L11 measures in: G59.3.
const FIXTURE: u16 = 9;
/// Work offsets of Fanuc and Haas that G10 L2 reaches: G54 to G59.
const FANUC_SYSTEMS: u16 = 6;

/// True, and reported, when a value is beyond any machine.
pub(super) fn out_of_range(value: f64, letter: u8, run: &mut Run<'_, '_>) -> bool {
    let beyond = value.abs() > POSITION_MAX_MM;
    if beyond {
        let span = run.words.span(letter, run.block);
        run.report
            .error("position-range", "the position is beyond any machine", span)
            .help("check the number");
    }
    beyond
}

type AxisWords = arrayvec::ArrayVec<(usize, f64), AXES>;

impl Control<'_> {
    pub(super) fn data_setting(&mut self, span: Span, run: &mut Run<'_, '_>) {
        let rs274 = self.rules.places_in_parameters;
        let form = run.words.take(b'L').unwrap_or(-1.0);
        let number = run.words.take(b'P');
        let mut words = AxisWords::new();
        let raw: AxisWords = run.words.axes().collect();
        for (axis, value) in raw {
            let letter = ALL_AXES[axis].letter();
            run.words.take(letter);
            let value = self.length_mm(axis, value);
            if out_of_range(value, letter, run) {
                return;
            }
            words.push((axis, value));
        }
        // The numbers of these forms are whole.
        let form = if form.fract() == 0.0 { form as i64 } else { -1 };
        match (rs274, form) {
            // Reads the tool table again, which changes no offset in force.
            (true, 0) => {}
            (true, 2 | 20) => self.set_system(form == 20, number, &words, span, run),
            (true, 1 | 10 | 11) => self.set_tool(form, number, &words, span, run),
            (false, 2 | 20) => self.fanuc_system(form == 20, number, &words, span, run),
            (false, -1) if self.dialect().lathe.is_some() && number == Some(0.0) => {
                // B-64304EN, "Programmable data input (G10)": P0 is no tool.
                run.report
                    .error(
                        "data-setting",
                        "G10 P0 shifts the workpiece coordinate system, which is not followed",
                        span,
                    )
                    .help("write the shift into the work offset (G10 L2 P1 …)");
            }
            (false, -1) if self.dialect().lathe.is_some() && number.is_some() => {
                // G10 P X Z R Q: an offset of a tool (B-63604EN, "Setting of
                // Tool Offset Data").
                for letter in [b'R', b'Q', b'Y'] {
                    run.words.take(letter);
                }
                let message = "the tool offsets that G10 sets are taken as 0, like all of them";
                run.report.note_once("tool-offset", message, span);
            }
            (false, 10..=13) => self.fanuc_tool(form, number, span, run),
            _ => {
                run.report
                    .error("data-setting", "this form of G10 is not supported", span)
                    .help(if rs274 {
                        "supported are L0, L1, L2, L10, L11 and L20"
                    } else {
                        "supported are L2, L20 and L10 to L13"
                    });
            }
        }
    }

    /// G10 L2 P R and L20 P of `LinuxCNC`.
    fn set_system(
        &mut self,
        from_place: bool,
        number: Option<f64>,
        words: &AxisWords,
        span: Span,
        run: &mut Run<'_, '_>,
    ) {
        let number = number.unwrap_or(-1.0);
        if number.fract() != 0.0 || !(0.0..=f64::from(SYSTEMS)).contains(&number) {
            run.report
                .error("data-setting", "G10 needs P from 0 to 9", span)
                .help("P is the number of the coordinate system, 0 is the one in force");
            return;
        }
        let active = self.position.offsets().system;
        let system = if number == 0.0 { active } else { number as u16 };
        let angle = run.words.take(b'R');
        if from_place && angle.is_some() {
            run.report
                .error("data-setting", "G10 L20 with R", span)
                .help("a turn is set by G10 L2");
            return;
        }
        let mut origin = self.position.offsets().origin_of(system);
        if from_place {
            if self.place_unknown(words, system, span, run) {
                return;
            }
            // The origin moves so that the place has these coordinates.
            let frame = self.position.offsets().frame_of(system, true);
            let here = frame.program(&self.position.at);
            let mut wanted = here;
            for &(axis, value) in words {
                wanted[axis] = value;
            }
            let [from, to] = [frame.machine(&wanted), frame.machine(&here)];
            for axis in 0..AXES {
                origin[axis] += to[axis] - from[axis];
            }
        } else {
            for &(axis, value) in words {
                origin[axis] = value;
            }
        }
        self.position.change(|offsets| {
            let before = offsets.origin_of(system);
            for (axis, value) in origin.into_iter().enumerate() {
                // What is not named stays what it was, known or not.
                if value != before[axis] || words.iter().any(|word| word.0 == axis) {
                    offsets.set_origin_of(system, axis, value);
                }
            }
            if let Some(angle) = angle {
                offsets.set_rotation_of(system, angle);
            }
            if system == active {
                offsets.load();
            }
        });
        for &(axis, _) in words.iter().filter(|_| from_place) {
            self.origin_from_place(system, axis);
        }
        self.note_bent();
    }

    /// True, and reported, when the place is needed but not known.
    fn place_unknown(
        &self,
        words: &AxisWords,
        system: u16,
        span: Span,
        run: &mut Run<'_, '_>,
    ) -> bool {
        let frame = self.position.offsets().frame_of(system, true);
        let unknown = self.position.unknown;
        let needed = words
            .iter()
            .any(|&(axis, _)| unknown.iter().any(|by| frame.depends(axis, by)));
        if needed {
            run.report
                .error(
                    "offset-from-unknown",
                    "an offset from a position that is not known",
                    span,
                )
                .help("give --start, or move the axes to a known position first");
        }
        needed
    }

    /// G10 L1, L10 and L11 of `LinuxCNC`: an entry of the tool table.
    fn set_tool(
        &mut self,
        form: i64,
        number: Option<f64>,
        words: &AxisWords,
        span: Span,
        run: &mut Run<'_, '_>,
    ) {
        let Some(number) = tool_number(number.unwrap_or(-1.0), span, run) else {
            return;
        };
        let Some(mut tool) = self.known_tool(number, span, run) else {
            return;
        };
        tool.number = number;
        let [radius, front, back, orientation] =
            [b'R', b'I', b'J', b'Q'].map(|letter| run.words.take(letter));
        if words.is_empty() && [radius, front, back, orientation] == [None; 4] {
            run.report
                .error("data-setting", "G10 sets nothing of the tool", span)
                .help("write axis words, R, I, J or Q");
            return;
        }
        let mut offset = self.tool_offsets_mm(&tool);
        if form == 1 {
            for &(axis, value) in words {
                offset[axis] = value;
            }
        } else {
            let system = if form == 11 {
                FIXTURE
            } else {
                self.position.offsets().system
            };
            if self.place_unknown(words, system, span, run) {
                return;
            }
            self.measure_tool(form == 11, system, words, &mut offset);
        }
        let offsets = self.position.offsets();
        tool.offsets = std::array::from_fn(|axis| offset[axis] / offsets.native(axis));
        if let Some(radius) = radius {
            tool.diameter = 2.0 * radius * self.modal.mm_per_unit / offsets.native(0);
        }
        tool.front_angle = front.unwrap_or(tool.front_angle);
        tool.back_angle = back.unwrap_or(tool.back_angle);
        match orientation {
            Some(value) if (0.0..=9.0).contains(&value) && value.fract() == 0.0 => {
                tool.orientation = value as u8;
            }
            Some(_) => {
                run.report
                    .error("data-setting", "Q of a tool is from 0 to 9", span)
                    .help("write the orientation of the tool");
                return;
            }
            None => {}
        }
        self.keep_tool(tool, span, run);
    }

    /// The tool's offsets become what makes the place have these coordinates,
    /// along the axes of a system that may be turned.
    fn measure_tool(
        &self,
        without_g92: bool,
        system: u16,
        words: &AxisWords,
        offset: &mut AxisValues,
    ) {
        let offsets = self.position.offsets();
        let mut here = offsets.frame_of(system, false).program(&self.position.at);
        if without_g92 {
            for (place, g92) in here.iter_mut().zip(offsets.g92) {
                *place += g92;
            }
        }
        let value = |axis: usize| words.iter().find(|word| word.0 == axis).map(|word| word.1);
        let angle = offsets.rotation_of(system);
        let turn = |angle| Affine::rotation([0, 1], [0.0; 2], angle);
        let mut along = turn(-angle).apply([offset[0], offset[1], 0.0]);
        for axis in 0..2 {
            if let Some(value) = value(axis) {
                along[axis] = here[axis] - value;
            }
        }
        if value(0).is_some() || value(1).is_some() {
            let turned = turn(angle).apply([along[0], along[1], 0.0]);
            offset[0] = turned[0];
            offset[1] = turned[1];
        }
        for axis in 2..AXES {
            if let Some(value) = value(axis) {
                offset[axis] = here[axis] - value;
            }
        }
    }

    fn keep_tool(&mut self, tool: Tool, span: Span, run: &mut Run<'_, '_>) {
        if !self.tools.set(tool) {
            run.report
                .error(
                    "data-setting",
                    "the program sets more than 1000 tools",
                    span,
                )
                .help("give them in a tool table");
        }
    }

    /// Fanuc: G10 L2 P0 (the common offset) to P6, and L20 P for G54.1;
    /// under G91 the values are added.
    fn fanuc_system(
        &mut self,
        further: bool,
        number: Option<f64>,
        words: &AxisWords,
        span: Span,
        run: &mut Run<'_, '_>,
    ) {
        let number = number.unwrap_or(-1.0);
        let range = if further {
            1.0..=f64::from(FURTHER_MAX)
        } else {
            0.0..=f64::from(FANUC_SYSTEMS)
        };
        if number.fract() != 0.0 || !range.contains(&number) {
            run.report
                .error("data-setting", "G10 without the number of its offset", span)
                .help("P is 0 to 6 for L2, 1 to 300 for L20");
            return;
        }
        if self.refuse_while_turned(span, run) {
            return;
        }
        let add = !self.modal.absolute;
        let system = number as u16 + if further { FURTHER } else { 0 };
        let add_to = |before: f64, value: f64| if add { before + value } else { value };
        let known = |axis| self.position.offsets().is_origin_known(system, axis);
        let unknown = words
            .iter()
            .map(|word| word.0)
            .filter(|axis| add && !known(*axis));
        let unknown: ArrayVec<usize, AXES> = unknown.collect();
        if system == 0 {
            // What it was before is not known either.
            self.set_all_unknown();
        }
        self.position.change(|offsets| {
            let mut values = if system == 0 {
                offsets.external
            } else {
                offsets.origin_of(system)
            };
            for &(axis, value) in words {
                values[axis] = add_to(values[axis], value);
            }
            if system == 0 {
                offsets.external = values;
            } else {
                for &(axis, _) in words {
                    offsets.set_origin_of(system, axis, values[axis]);
                }
                for axis in unknown {
                    offsets.forget_origin(system, axis);
                }
            }
            if system == offsets.system {
                offsets.load();
            }
        });
    }

    /// Fanuc: G10 L10 (length), L11 (wear of length), L12 and L13 (radius),
    /// with P and R. Wear starts at 0: the table has the lengths in all.
    fn fanuc_tool(&mut self, form: i64, number: Option<f64>, span: Span, run: &mut Run<'_, '_>) {
        let Some(number) = tool_number(number.unwrap_or(-1.0), span, run) else {
            return;
        };
        let Some(value) = run.words.take(b'R') else {
            run.report
                .error("data-setting", "G10 sets nothing of the tool", span)
                .help("write the value as R");
            return;
        };
        let mut tool = self.tools.find(number).unwrap_or_default();
        tool.number = number;
        let native = self.position.offsets().native(2);
        let value = value * self.modal.mm_per_unit / native;
        let add = !self.modal.absolute;
        match (form, add) {
            (10, false) => tool.offsets[2] = value,
            (10 | 11, true) => tool.offsets[2] += value,
            (12, false) => tool.diameter = 2.0 * value,
            (12 | 13, true) => tool.diameter += 2.0 * value,
            (11 | 13, false) if value == 0.0 => {}
            _ => {
                run.report
                    .error("data-setting", "the wear of a tool, given outright", span)
                    .help("the table does not keep it apart: give lengths and radii in all");
                return;
            }
        }
        self.keep_tool(tool, span, run);
    }
}
