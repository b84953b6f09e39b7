//! Which model the options of `identify` ask for, and whether they go together.

use anyhow::{Result, ensure};
use gwatt::identify::Given;
use gwatt::identify::flexible::{Choice, Method};
use gwatt::identify::rigid::Friction;

use crate::cli::{FrictionArg, IdentifyArgs, MethodArg, ModelArg};

/// Orders of models that are tried.
const ORDER_MAX: usize = 12;

/// What an axis is taken for, with what goes with it.
pub enum ModelChoice {
    /// Mass and friction.
    Rigid {
        /// How friction is modelled; as the data have it, where that is not given.
        friction: Option<Friction>,
        /// Band of the filter, Hz.
        bandwidth_hz: Option<f64>,
    },
    /// Resonances and anti-resonances.
    Flexible(Choice),
}

/// How a flexible axis is estimated, where that is not given too.
pub fn method(asked: Option<MethodArg>) -> Method {
    match asked {
        None | Some(MethodArg::Iv) => Method::Iv,
        Some(MethodArg::Arx) => Method::Arx,
        Some(MethodArg::Frequency) => Method::Frequency,
        Some(MethodArg::Subspace) => Method::Subspace,
    }
}

/// The options that only a flexible axis has, as far as they are given.
fn flexible_only(args: &IdentifyArgs) -> Vec<&'static str> {
    let options = [
        ("--method", args.method.is_some()),
        ("--order", args.order.is_some()),
        ("--zeros", args.zeros.is_some()),
        ("--delay-ms", args.delay_ms.is_some()),
        ("--from-command", args.from_command),
        ("--response", args.response.is_some()),
    ];
    given(&options)
}

/// The options that only a rigid axis has, as far as they are given.
fn rigid_only(args: &IdentifyArgs) -> Vec<&'static str> {
    let options = [
        ("--friction", args.friction.is_some()),
        ("--bandwidth-hz", args.bandwidth_hz.is_some()),
    ];
    given(&options)
}

fn given(options: &[(&'static str, bool)]) -> Vec<&'static str> {
    let given = options.iter().filter(|(_, is_given)| *is_given);
    given.map(|(name, _)| *name).collect()
}

impl ModelChoice {
    /// The model of these options: that which is named, else that which they need.
    ///
    /// # Errors
    ///
    /// Options that do not go together, or values out of their range.
    pub fn of(args: &IdentifyArgs) -> Result<Self> {
        let (flexible, rigid) = (flexible_only(args), rigid_only(args));
        let model = args.model.unwrap_or(if flexible.is_empty() {
            ModelArg::Rigid
        } else {
            ModelArg::Flexible
        });
        let (name, useless) = match model {
            ModelArg::Rigid => ("rigid", flexible),
            ModelArg::Flexible => ("flexible", rigid),
        };
        ensure!(
            useless.is_empty(),
            "{} {} no meaning for a {name} axis",
            useless.join(" and "),
            if useless.len() == 1 { "has" } else { "have" },
        );
        match model {
            ModelArg::Rigid => Self::rigid(args),
            ModelArg::Flexible => Ok(Self::Flexible(choice(args)?)),
        }
    }

    fn rigid(args: &IdentifyArgs) -> Result<Self> {
        if let Some(hz) = args.bandwidth_hz {
            ensure!(
                hz.is_finite() && hz > 0.0,
                "--bandwidth-hz {hz} is not positive"
            );
        }
        Ok(Self::Rigid {
            friction: args.friction.map(|friction| match friction {
                FrictionArg::Symmetric => Friction::Symmetric,
                FrictionArg::Directional => Friction::Directional,
            }),
            bandwidth_hz: args.bandwidth_hz,
        })
    }
}

fn choice(args: &IdentifyArgs) -> Result<Choice> {
    ensure!(
        args.order.is_none_or(|order| order <= ORDER_MAX),
        "--order is at most {ORDER_MAX}"
    );
    let method = method(args.method);
    ensure!(
        args.zeros.is_none() || method == Method::Iv,
        "--zeros goes with --method iv alone: the others have as many zeros as they find"
    );
    let delay_s = args.delay_ms.map(|ms| ms * 1e-3);
    ensure!(
        delay_s.is_none_or(|delay| (0.0..10.0).contains(&delay)),
        "--delay-ms is not between 0 and 10000"
    );
    Ok(Choice {
        method,
        given: Given {
            order: args.order,
            zeros: args.zeros,
            delay_s,
        },
        from_command: args.from_command,
    })
}
