//! Results for people and for other programs: one writer for each format.

mod aligned;
mod baseline;
mod chart;
mod checked;
mod circle_chart;
mod comparison;
mod contour_chart;
mod contoured;
mod csv;
mod drawing;
mod drives;
mod effects;
mod estimate;
mod figure;
mod finding;
mod github;
mod held;
#[cfg(feature = "html")]
mod html;
mod identified;
#[cfg(feature = "html")]
mod identify_page;
mod json;
#[cfg(feature = "junit")]
mod junit;
mod known_comment;
mod level_table;
mod line_edits;
mod mass_table;
mod moves;
mod over_time;
mod overlay_chart;
mod patch;
mod quantity;
mod record;
mod results;
#[cfg(feature = "sarif")]
mod sarif;
mod series;
mod size;
mod spindle;
mod style;
mod text;
#[cfg(feature = "html")]
mod tune_page;
mod tuned;
mod verified;
#[cfg(feature = "html")]
mod verified_page;

pub use baseline::{Baseline, BaselineError};
pub use chart::SpindleChart;
pub use checked::{Changes, Checked, Totals, Verdict, chain};
pub use circle_chart::circle_chart;
pub use comparison::{Change, Comparison, comparison_csv, comparison_text};
pub use contour_chart::ContourChart;
pub use contoured::{
    ArcList, CONTOUR_COLUMNS, contour_csv_row, contour_json, contour_json_row, contour_text,
};
pub use csv::CsvRows;
pub use drives::{DriveRows, drives_text};
pub use github::github;
pub use held::Held;
#[cfg(feature = "html")]
pub use html::{Compared, Found, LineTexts, Page, PageRows, PageSeries, SetPage, Side};
pub use identified::{
    Heading, flexible_json, flexible_text, margin, power_model_json, power_model_text, rigid_json,
    rigid_text,
};
#[cfg(feature = "html")]
pub use identify_page::{flexible_page, rigid_page};
pub use json::{JsonRows, check_json, check_json_line, limit_json, report_json, set_json};
#[cfg(feature = "junit")]
pub use junit::junit;
pub use level_table::level_table;
pub use line_edits::{LineEdit, line_edits};
pub use mass_table::mass_table;
pub use moves::write_move;
pub use overlay_chart::OverlayChart;
pub use patch::unified_diff;
pub use quantity::{duration, power};
pub use record::COLUMNS;
#[cfg(feature = "sarif")]
pub use sarif::sarif;
pub use series::{SeriesColumns, SeriesRows};
pub use size::{size_chart, size_csv, size_json, size_text, size_verdict};
pub use spindle::{SpindleRows, spindle_text};
pub use style::Style;
pub use text::{axis_table, check_text, limit_text, partial_text, set_text};
#[cfg(feature = "html")]
pub use tune_page::tune_page;
pub use tuned::{sections_csv, tuned_json, tuned_text};
pub use verified::{VerifiedNames, verified_csv, verified_json, verified_text};
#[cfg(feature = "html")]
pub use verified_page::verified_page;
