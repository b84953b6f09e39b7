//! Speeds, accelerations and places of the axes.

use gwatt_machine::AxisId;

use super::parameters::{Parameters, Value};
use crate::found::{Figure, Found, entry, highest, shown};
use crate::text::Log;

/// Seconds of a minute, milliseconds of a second.
const MIN: f64 = 60.0;
const MS: f64 = 1e-3;

/// An axis while it is read.
struct Reader<'p, 't> {
    parameters: &'p Parameters<'t>,
    /// From 1.
    index: usize,
    rotary: bool,
}

/// Reads the axes that have a rapid speed.
pub(super) fn take(parameters: &Parameters<'_>, found: &mut Found, log: &mut Log) {
    let mut taken: Vec<AxisId> = Vec::new();
    for value in parameters.of(1420) {
        let index = value.index.max(1);
        if !parameters.exists(index) {
            continue;
        }
        let Some(id) = letter(parameters, index, log, value) else {
            continue;
        };
        if taken.contains(&id) {
            let message = format!(
                "there is another axis {}: only the first is taken",
                id.letter() as char
            );
            log.warning(
                &value.place,
                message,
                "give each path of the control a file of its own",
            );
            continue;
        }
        taken.push(id);
        axis(parameters, found, log, (id, index), value);
    }
}

/// Parameter 1020 has the letter as a character code.
fn letter(
    parameters: &Parameters<'_>,
    index: usize,
    log: &mut Log,
    at: &Value<'_>,
) -> Option<AxisId> {
    let Some(name) = parameters.axis(1020, index) else {
        let usual = [AxisId::X, AxisId::Y, AxisId::Z];
        let found = usual.get(index - 1).copied();
        let (message, help) = match found {
            Some(id) => (
                format!(
                    "parameter 1020 has no name for axis {index}: taken for {}",
                    id.letter() as char
                ),
                "add parameter 1020 to the file if it is another one",
            ),
            None => (
                format!("parameter 1020 has no name for axis {index}: it is left out"),
                "add parameter 1020 to the file, or the axis by hand",
            ),
        };
        log.warning(&at.place, message, help);
        return found;
    };
    let code = name.text.parse::<u8>().ok();
    let found = code
        .and_then(AxisId::from_letter)
        .filter(|id| *id != AxisId::E);
    if found.is_none() {
        let message = format!(
            "the name of axis {index} ({}) is no axis that gwatt knows",
            name.text
        );
        log.warning(
            &name.place,
            message,
            "it is left out: gwatt knows X Y Z A B C U V W",
        );
    }
    found
}

fn axis(
    parameters: &Parameters<'_>,
    found: &mut Found,
    log: &mut Log,
    of: (AxisId, usize),
    rapid: &Value<'_>,
) {
    let (id, index) = of;
    let turns = parameters
        .bits(1006, 0)
        .into_iter()
        .find(|bit| bit.index == index);
    let by_letter = matches!(id, AxisId::A | AxisId::B | AxisId::C);
    let reader = Reader {
        parameters,
        index,
        rotary: turns.map_or(by_letter, |bit| bit.on),
    };
    let letter = id.letter() as char;
    let Some(first) = log.positive(
        &rapid.place,
        rapid.text,
        &format!("a rapid speed of axis {letter}"),
    ) else {
        found.axis(id);
        return;
    };
    let rapid = Figure::new(first * reader.speed_unit(rapid.text), rapid.source.clone());
    let feed = reader.speed(1430, log).filter(|it| it.value > 0.0);
    let feed = feed
        .or_else(|| reader.speed(1422, log))
        .filter(|it| it.value > 0.0);
    let rapid = match feed.clone().filter(|feed| feed.value > rapid.value) {
        Some(feed) => Figure::new(
            feed.value,
            format!("cutting may be faster than rapids: {}", feed.source),
        ),
        None => rapid,
    };
    let accel = reader.accel(log, &rapid, feed);
    let reference = reader.position(1240, log);
    let further = (1241..=1243).map_while(|number| reader.position(number, log));
    let further_references = further.collect();
    let [max, min] = [1320, 1321].map(|number| reader.position(number, log));
    let axis = found.axis(id);
    axis.rotary = reader.rotary;
    (axis.rapid, axis.accel, axis.reference) = (Some(rapid), accel, reference);
    axis.further_references = further_references;
    if let (Some(min), Some(max)) = (min, max) {
        axis.travel(&min, &max, "");
    }
    let unit = if reader.rotary { "deg" } else { "mm" };
    if let Some(speed) = reader.speed(1428, log).filter(|it| it.value > 0.0) {
        let why = format!(
            "before the reference point is known: {}; after that G28 is a rapid",
            speed.source
        );
        axis.maybe.push(entry(
            format!("reference_{unit}_min = {}", shown(speed.value)),
            why,
        ));
    }
}

impl<'t> Reader<'_, 't> {
    fn value(&self, number: u32) -> Option<&Value<'t>> {
        let own = self.parameters.axis(number, self.index);
        own.or_else(|| self.parameters.of_path(number, self.index))
    }

    fn figure(&self, number: u32, log: &mut Log) -> Option<(Figure, &'t str)> {
        let value = self.value(number)?;
        let read = log.number(&value.place, value.text)?;
        Some((Figure::new(read, value.source.clone()), value.text))
    }

    fn speed_unit(&self, text: &str) -> f64 {
        if self.rotary {
            1.0
        } else {
            self.parameters.speed_unit(text)
        }
    }

    fn speed(&self, number: u32, log: &mut Log) -> Option<Figure> {
        let (figure, text) = self.figure(number, log)?;
        Some(figure.times(self.speed_unit(text)))
    }

    fn position(&self, number: u32, log: &mut Log) -> Option<Figure> {
        let (figure, text) = self.figure(number, log)?;
        Some(figure.times(self.parameters.position_unit(text, self.rotary)))
    }

    /// The highest of the accelerations that may hold: of rapids (1420 in 1620), of cutting
    /// after interpolation (1430 or 1422 in 1622), before interpolation (1660, 1671; 1630 in
    /// 1631, 1770 in 1771).
    fn accel(&self, log: &mut Log, rapid: &Figure, feed: Option<Figure>) -> Option<Figure> {
        let largest = feed.unwrap_or_else(|| rapid.clone());
        let bits = self.parameters.bits(1610, 1);
        let bell = bits
            .iter()
            .any(|bit| bit.on && (bit.index == self.index || bit.index == 0));
        let pairs = [
            (Some(rapid.clone()), 1620),
            (Some(largest), 1622),
            (self.speed(1630, log), 1631),
            (self.speed(1770, log), 1771),
        ];
        let mut list: Vec<Figure> = Vec::new();
        for (speed, number) in pairs {
            let time = self
                .figure(number, log)
                .filter(|(time, _)| time.value > 0.0);
            let (Some(speed), Some((time, _))) = (speed.filter(|it| it.value > 0.0), time) else {
                continue;
            };
            // A bell of that time is twice as steep at its middle.
            let (steep, shape) = if bell && number == 1622 {
                (2.0, "twice, as a bell, ")
            } else {
                (1.0, "")
            };
            let accel = steep * speed.value / MIN / (time.value * MS);
            let (speed, ms) = (shown(speed.value), shown(time.value));
            let source = format!("{shape}{speed}/min in {ms} ms: {}", time.source);
            list.push(Figure::new(accel, source));
        }
        let inch = if self.rotary {
            1.0
        } else {
            self.parameters.inch()
        };
        for number in [1660, 1671] {
            let direct = self.figure(number, log).filter(|(it, _)| it.value > 0.0);
            list.extend(direct.map(|(it, _)| it.times(inch)));
        }
        highest(list)
    }
}
