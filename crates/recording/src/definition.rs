//! The `.msg` definition of a record in the ROS 2 interface language, with those of its parts appended: what the MCAP
//! registry calls the schema encoding `ros2msg`.

use messages::Record;

/// The package our own types belong to.
pub(crate) const PACKAGE: &str = "gangwerk_msgs";

const SEPARATOR: &str = "================================================================================\n";
const SCALARS: [&str; 5] = ["float64", "uint64", "uint32", "int32", "uint8"];

/// Name of the ROS 2 interface of a record type, e.g. `gangwerk_msgs/msg/Sensors`.
pub fn interface<T: Record>() -> String {
    format!("{PACKAGE}/msg/{}", T::NAME)
}

/// Definition of the record, then of every struct it is made of, each once.
pub fn definition<T: Record>() -> String {
    let mut parts: Vec<(&str, String)> = Vec::new();
    T::describe(&mut |name, fields| {
        if parts.iter().all(|(known, _)| *known != name) {
            let lines = fields
                .iter()
                .map(|(type_name, field)| format!("{} {field}\n", qualified(type_name)))
                .collect();
            parts.push((name, lines));
        }
    });
    // Inner structs are described first, so the record itself is the last.
    let mut text = parts.pop().map_or_else(String::new, |(_, lines)| lines);
    for (name, lines) in parts {
        text.push_str(&format!("{SEPARATOR}MSG: {PACKAGE}/{name}\n{lines}"));
    }
    text
}

/// Structs carry their package: a bare `Header` would be taken for the one of `std_msgs`.
fn qualified(type_name: &str) -> String {
    let scalar = type_name.split('[').next().unwrap_or_default();
    if SCALARS.contains(&scalar) { type_name.into() } else { format!("{PACKAGE}/{type_name}") }
}
