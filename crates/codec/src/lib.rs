//! Records to bus frames and back, for both ends of the field bus and for the tools that read its traffic.
//!
//! - [`layout`]: position, scale and meaning of each number in the frames. It is data: `config` makes it from a robot's DBC
//!   files.
//! - [`frames`]: encoding and decoding by such a layout, and what became of the frames of a cycle.
//! - [`interpreter`]: telegrams to and from the interpreters of drives that play tables; [`room`]: how many of them a cycle
//!   has room for; [`network`]: how such drives are started, and say that they are.

pub mod frames;
pub mod interpreter;
pub mod layout;
pub mod network;
pub mod room;
