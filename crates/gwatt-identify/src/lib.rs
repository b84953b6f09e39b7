#![doc = include_str!("../README.md")]
//!
//! # From recordings to parameters
//!
//! A [`Recording`] is read, checked and turned to SI. [`rigid`] fits mass and
//! friction. [`flexible`] finds the [`TransferFunction`] from force to
//! acceleration, whose zeros are the axis' anti-resonances. [`power_fit`] fits the
//! electrical power of an axis. [`tune`] makes the filters that let several axes
//! answer alike. [`excitation`] makes signals that excite an axis,
//! [`design`] the best one for an axis of which something is known. [`merge`] and
//! [`response_table`] write what was found into machine files.

pub mod design;
pub mod effects;
pub mod excitation;
pub mod flexible;
pub mod judgement;
pub mod merge;
pub mod overlay;
pub mod power_fit;
pub mod response_table;
pub mod rigid;
pub mod tune;

mod agreement;
mod any_delay;
mod arx;
mod certainty;
mod charge;
mod choice;
mod column;
mod column_map;
mod command_input;
mod constancy;
mod creeping;
mod data;
mod delay_profile;
mod descent;
mod described;
mod discrete;
mod disturbance;
mod measured_noise;
mod equations;
mod fewer_rows;
mod figure;
mod filter;
mod friction;
mod header_name;
mod integrated;
mod stepwise_search;
mod lateness;
mod layout;
mod leaky_integrator;
mod left;
mod mean_speed;
mod methods;
mod modal;
mod missed;
mod mode;
mod mode_starts;
mod candidate_models;
mod next_to_friction;
mod friction_loop;
mod noise;
mod normal;
mod output_error;
mod parallel;
mod parameters;
mod parts;
mod peak_factor;
mod places;
mod polynomial;
mod power_log;
mod prepared;
mod preset;
mod quality;

mod recording;
mod response_fit;
mod response_starts;
mod rigidity;
mod roots;
mod rows;
mod rubbing;
mod sampling;
mod sandwich;
mod search;
mod slow_motion;
mod speeds;
mod chosen;
mod sensitivity;
mod spectrum;
mod spectral_lines;
mod state_space;
mod stretch;
mod subspace;
mod transfer;
mod error;
mod estimate;

pub use candidate_models::Given;
pub use column::{Kind, Quantity};
pub use column_map::MappedColumn;
pub use discrete::{Discrete, NoTwin, SampledResponse};
pub use error::{IdentifyError, Outcome};
pub use figure::Figure;
pub use judgement::Judgement;
pub use noise::Whiteness;
pub use peak_factor::PeakFactor;
pub use polynomial::roots;
pub use preset::Preset;
pub use recording::{ReadAs, Recording, Signal};
pub use spectrum::{FrequencyResponse, measure};
pub use state_space::{Measured, Sampled, Simulation, simulate};
pub use transfer::{Factor, TransferFunction, factors_of};
