//! The picture of a program: one page, or a still picture.
//!
//! Input: the rows of a report, the planned power over time, the text of lines. Output: a
//! page that needs no network, and SVG. What is kept of a program does not grow with it:
//! where there is too much, neighbours become one, and the larger value stays.

mod bars;
mod block;
mod cell;
mod columns;
mod columns_drawn;
mod data;
mod door;
mod figures;
mod joined;
mod lines;
mod page;
mod path;
mod peaks;
mod picture;
mod picture_voltage;
mod rows;
mod set_page;
mod shares;
mod shown;
mod voltage;

pub(super) use picture::escaped;

pub use lines::LineTexts;
pub use rows::PageRows;
pub use set_page::SetPage;
pub use shares::{PageSeries, Side};
pub use shown::{Compared, Found, Page};
