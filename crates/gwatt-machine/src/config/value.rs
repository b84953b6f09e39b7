//! Values of a file, each with the place where it stands.
//!
//! The range of a number is part of its type: from it come the JSON Schema
//! and the check, so the two cannot differ.

use std::borrow::Cow;
use std::marker::PhantomData;
use std::ops::Range;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer};

use crate::axis::AxisId;

/// A value and the bytes of the file that it comes from.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct At<T> {
    pub(crate) value: T,
    pub(crate) span: Range<usize>,
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for At<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let spanned = toml::Spanned::<T>::deserialize(deserializer)?;
        let span = spanned.span();
        Ok(Self {
            value: spanned.into_inner(),
            span,
        })
    }
}

impl<T: JsonSchema> JsonSchema for At<T> {
    fn inline_schema() -> bool {
        T::inline_schema()
    }
    fn schema_name() -> Cow<'static, str> {
        T::schema_name()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        T::json_schema(generator)
    }
}

/// A range of numbers; the flag says whether the bound itself is outside.
pub(crate) trait Bounds {
    const NAME: &'static str;
    const MIN: Option<(f64, bool)> = None;
    const MAX: Option<(f64, bool)> = None;
}

/// A finite number within bounds.
#[derive(Debug, Clone)]
pub(crate) struct Num<B> {
    pub(crate) value: f64,
    pub(crate) span: Range<usize>,
    bounds: PhantomData<B>,
}

impl<B> Num<B> {
    /// The value alone.
    pub(crate) fn at(&self) -> At<f64> {
        At {
            value: self.value,
            span: self.span.clone(),
        }
    }
}

impl<'de, B> Deserialize<'de> for Num<B> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let At { value, span } = At::<f64>::deserialize(deserializer)?;
        Ok(Self {
            // Not -0, the reciprocal of which is negative.
            value: value + 0.0,
            span,
            bounds: PhantomData,
        })
    }
}

impl<B: Bounds> JsonSchema for Num<B> {
    fn inline_schema() -> bool {
        true
    }
    fn schema_name() -> Cow<'static, str> {
        B::NAME.into()
    }
    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let mut schema = json_schema!({ "type": "number" });
        let bounds = [
            (B::MIN, "minimum", "exclusiveMinimum"),
            (B::MAX, "maximum", "exclusiveMaximum"),
        ];
        for (bound, inclusive, exclusive) in bounds {
            if let Some((value, outside)) = bound {
                let key = if outside { exclusive } else { inclusive };
                schema.insert(key.to_owned(), value.into());
            }
        }
        schema
    }
}

macro_rules! number {
    ($(#[$doc:meta])* $bounds:ident, $name:ident, $min:expr, $max:expr) => {
        #[derive(Debug, Clone)]
        pub(crate) struct $bounds;
        impl Bounds for $bounds {
            const NAME: &'static str = stringify!($name);
            const MIN: Option<(f64, bool)> = $min;
            const MAX: Option<(f64, bool)> = $max;
        }
        $(#[$doc])*
        pub(crate) type $name = Num<$bounds>;
    };
}

number!(/** Any finite number. */ AnyBounds, Number, None, None);
number!(/** Greater than zero. */ PositiveBounds, Positive, Some((0.0, true)), None);
number!(/** Zero or more. */ NotNegativeBounds, NotNegative, Some((0.0, false)), None);
number!(/** One or more. */ AtLeastOneBounds, AtLeastOne, Some((1.0, false)), None);
number!(/** A share that may be the whole, but not nothing. */
    ShareBounds, Share, Some((0.0, true)), Some((1.0, false)));
number!(/** A share from nothing to the whole. */
    FractionBounds, Fraction, Some((0.0, false)), Some((1.0, false)));
number!(/** A share that may be nothing, but not the whole. */
    PartBounds, Part, Some((0.0, false)), Some((1.0, true)));
number!(/** Percent that cannot exceed 100. */
    RapidPercentBounds, RapidPercent, Some((1.0, false)), Some((100.0, false)));

number!(/** Seconds from a thousandth to one. */
    ResponseTimeBounds, ResponseTime, Some((0.001, false)), Some((1.0, false)));

/// One value, or a list of them.
#[derive(Debug, Clone)]
pub(crate) struct OneOrMany<T>(pub(crate) Vec<At<T>>);

impl<'de, T: Deserialize<'de>> Deserialize<'de> for OneOrMany<T> {
    // The structure check has put a single value into a list.
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Vec::deserialize(deserializer).map(Self)
    }
}

impl<T: JsonSchema> JsonSchema for OneOrMany<T> {
    fn inline_schema() -> bool {
        true
    }
    fn schema_name() -> Cow<'static, str> {
        format!("OneOrMany_{}", T::schema_name()).into()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "anyOf": [
                generator.subschema_for::<T>(),
                { "type": "array", "items": generator.subschema_for::<T>(), "minItems": 1 },
            ]
        })
    }
}

/// A value for each axis letter.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "UPPERCASE")]
pub(crate) struct PerAxis<T> {
    x: Option<T>,
    y: Option<T>,
    z: Option<T>,
    a: Option<T>,
    b: Option<T>,
    c: Option<T>,
    u: Option<T>,
    v: Option<T>,
    w: Option<T>,
    e: Option<T>,
}

impl<T> PerAxis<T> {
    /// The values that are given, in the order of reports.
    pub(crate) fn iter(&self) -> impl Iterator<Item = (AxisId, &T)> {
        [
            (AxisId::X, &self.x),
            (AxisId::Y, &self.y),
            (AxisId::Z, &self.z),
            (AxisId::A, &self.a),
            (AxisId::B, &self.b),
            (AxisId::C, &self.c),
            (AxisId::U, &self.u),
            (AxisId::V, &self.v),
            (AxisId::W, &self.w),
            (AxisId::E, &self.e),
        ]
        .into_iter()
        .filter_map(|(axis, value)| value.as_ref().map(|value| (axis, value)))
    }
}

/// An axis letter in a list.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
pub(crate) enum Letter {
    X,
    Y,
    Z,
    A,
    B,
    C,
    U,
    V,
    W,
    E,
}

impl Letter {
    /// The axis of this letter.
    pub(crate) fn axis(self) -> AxisId {
        crate::axis::ALL_AXES[self as usize]
    }
}
