//! The CAN side of the field bus, for both of its ends and for the tools that listen: sockets, recordings, faults.
//!
//! Layouts of frames are data: `config/robots/NAME/can/*.dbc`, read by `config`, used by [`messages::frames`].
