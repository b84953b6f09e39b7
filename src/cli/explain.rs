//! Arguments of `explain`.

use clap::Args;

const EXAMPLES: &str = "\
Examples:
  gwatt explain                list all rules
  gwatt explain arc-radius     what error[arc-radius] means, and what to do
  gwatt explain arc-radius peak-power";

/// Arguments of `explain`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct ExplainArgs {
    /// Rules as messages name them: what they mean, why they matter for the power, an example,
    /// what to do [default: the list of all rules]
    #[arg(value_name = "RULE")]
    pub rules: Vec<String>,
}
