//! Definitions of the standard ROS 2 messages a log contains, as `ros2msg` schemas. They are interface facts and must
//! not be changed: `tests/peers/rosbags.sh` compares their type hashes with those of a ROS 2 distribution.

use messages::Topic;
use messages::topics::{CONTROLLER_STATE, EVENTS, PLAN, SENSORS, SIM_STATE};

/// Origin of what the robot believes about itself.
const BELIEVED: &[&Topic] = &[&SENSORS, &CONTROLLER_STATE, &PLAN];

const HEADER: &str = "MSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n";
pub(crate) const TIME: &str = "MSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n";
const DURATION: &str = "MSG: builtin_interfaces/Duration\nint32 sec\nuint32 nanosec\n";
const VECTOR3: &str = "MSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n";
const POINT: &str = "MSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n";
const QUATERNION: &str =
    "MSG: geometry_msgs/Quaternion\nfloat64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n";
const POSE: &str =
    "MSG: geometry_msgs/Pose\ngeometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n";
const COLOR: &str = "MSG: std_msgs/ColorRGBA\nfloat32 r\nfloat32 g\nfloat32 b\nfloat32 a\n";

/// A standard channel: topic, interface, definition and the definitions it needs.
pub(crate) struct Standard {
    pub(crate) topic: &'static str,
    pub(crate) interface: &'static str,
    body: &'static str,
    parts: &'static [&'static str],
    /// Topics whose records it is made from; none: it is said once.
    pub(crate) sources: &'static [&'static Topic],
}

impl Standard {
    /// The schema text.
    pub(crate) fn definition(&self) -> String {
        let separator = "=".repeat(80);
        self.parts.iter().fold(self.body.to_string(), |text, part| format!("{text}{separator}\n{part}"))
    }
}

/// Measured joint angles and speeds.
pub(crate) const JOINT_STATES: Standard = Standard {
    topic: "/joint_states",
    interface: "sensor_msgs/msg/JointState",
    body: "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort\n",
    parts: &[HEADER, TIME],
    sources: &[&SENSORS],
};

/// Upper body.
pub(crate) const IMU: Standard = Standard {
    topic: "/imu/data",
    interface: "sensor_msgs/msg/Imu",
    body: "std_msgs/Header header\n\
           geometry_msgs/Quaternion orientation\nfloat64[9] orientation_covariance\n\
           geometry_msgs/Vector3 angular_velocity\nfloat64[9] angular_velocity_covariance\n\
           geometry_msgs/Vector3 linear_acceleration\nfloat64[9] linear_acceleration_covariance\n",
    parts: &[HEADER, TIME, QUATERNION, VECTOR3],
    sources: &[&SENSORS],
};

const WRENCH_BODY: &str = "std_msgs/Header header\ngeometry_msgs/Wrench wrench\n";
const WRENCH_PARTS: &[&str] = &[
    HEADER,
    TIME,
    "MSG: geometry_msgs/Wrench\ngeometry_msgs/Vector3 force\ngeometry_msgs/Vector3 torque\n",
    VECTOR3,
];

/// Force/torque sensors of the feet: right, left.
pub(crate) const FOOT_WRENCH: [Standard; 2] = [
    Standard {
        topic: "/foot/right/wrench",
        interface: "geometry_msgs/msg/WrenchStamped",
        body: WRENCH_BODY,
        parts: WRENCH_PARTS,
        sources: &[&SENSORS],
    },
    Standard {
        topic: "/foot/left/wrench",
        interface: "geometry_msgs/msg/WrenchStamped",
        body: WRENCH_BODY,
        parts: WRENCH_PARTS,
        sources: &[&SENSORS],
    },
];

const TF_BODY: &str = "geometry_msgs/TransformStamped[] transforms\n";
const TF_PARTS: &[&str] = &[
    "MSG: geometry_msgs/TransformStamped\nstd_msgs/Header header\nstring child_frame_id\n\
     geometry_msgs/Transform transform\n",
    "MSG: geometry_msgs/Transform\ngeometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n",
    HEADER,
    TIME,
    VECTOR3,
    QUATERNION,
];

/// Frames that move.
pub(crate) const TF: Standard = Standard {
    topic: "/tf",
    interface: "tf2_msgs/msg/TFMessage",
    body: TF_BODY,
    parts: TF_PARTS,
    sources: BELIEVED,
};

/// The same of the simulated robot as it is.
pub(crate) const TRUTH_TF: Standard = Standard {
    topic: "/truth/tf",
    interface: "tf2_msgs/msg/TFMessage",
    body: TF_BODY,
    parts: TF_PARTS,
    sources: &[&SIM_STATE],
};

/// Frames that do not, once.
pub(crate) const TF_STATIC: Standard = Standard {
    topic: "/tf_static",
    interface: "tf2_msgs/msg/TFMessage",
    body: TF_BODY,
    parts: TF_PARTS,
    sources: &[],
};

/// Event in words.
pub(crate) const ROSOUT: Standard = Standard {
    topic: "/rosout",
    interface: "rcl_interfaces/msg/Log",
    body: "byte DEBUG=10\nbyte INFO=20\nbyte WARN=30\nbyte ERROR=40\nbyte FATAL=50\n\
           builtin_interfaces/Time stamp\nuint8 level\nstring name\nstring msg\nstring file\nstring function\nuint32 line\n",
    parts: &[TIME],
    sources: &EVENTS,
};

const MARKERS_BODY: &str = "visualization_msgs/Marker[] markers\n";
const MARKERS_PARTS: &[&str] = &[
    "MSG: visualization_msgs/Marker\n\
         int32 ARROW=0\nint32 CUBE=1\nint32 SPHERE=2\nint32 CYLINDER=3\nint32 LINE_STRIP=4\nint32 LINE_LIST=5\n\
         int32 CUBE_LIST=6\nint32 SPHERE_LIST=7\nint32 POINTS=8\nint32 TEXT_VIEW_FACING=9\n\
         int32 MESH_RESOURCE=10\nint32 TRIANGLE_LIST=11\n\
         int32 ADD=0\nint32 MODIFY=0\nint32 DELETE=2\nint32 DELETEALL=3\n\
         std_msgs/Header header\nstring ns\nint32 id\nint32 type\nint32 action\ngeometry_msgs/Pose pose\n\
         geometry_msgs/Vector3 scale\nstd_msgs/ColorRGBA color\nbuiltin_interfaces/Duration lifetime\n\
         bool frame_locked\ngeometry_msgs/Point[] points\nstd_msgs/ColorRGBA[] colors\n\
         string texture_resource\nsensor_msgs/CompressedImage texture\n\
         visualization_msgs/UVCoordinate[] uv_coordinates\nstring text\nstring mesh_resource\n\
         visualization_msgs/MeshFile mesh_file\nbool mesh_use_embedded_materials\n",
    "MSG: sensor_msgs/CompressedImage\nstd_msgs/Header header\nstring format\nuint8[] data\n",
    "MSG: visualization_msgs/UVCoordinate\nfloat32 u\nfloat32 v\n",
    "MSG: visualization_msgs/MeshFile\nstring filename\nuint8[] data\n",
    HEADER,
    TIME,
    DURATION,
    VECTOR3,
    POINT,
    QUATERNION,
    POSE,
    COLOR,
];

/// Ground, planned steps, zero-moment point, support polygon, centre of gravity.
pub(crate) const MARKERS: Standard = Standard {
    topic: "/markers",
    interface: "visualization_msgs/msg/MarkerArray",
    body: MARKERS_BODY,
    parts: MARKERS_PARTS,
    sources: BELIEVED,
};

/// The same of the simulated robot as it is.
pub(crate) const TRUTH_MARKERS: Standard = Standard {
    topic: "/truth/markers",
    interface: "visualization_msgs/msg/MarkerArray",
    body: MARKERS_BODY,
    parts: MARKERS_PARTS,
    sources: &[&SIM_STATE],
};

/// The URDF, once.
pub(crate) const ROBOT_DESCRIPTION: Standard = Standard {
    topic: "/robot_description",
    interface: "std_msgs/msg/String",
    body: "string data\n",
    parts: &[],
    sources: &[],
};

/// All of them.
pub(crate) const STANDARD: [&Standard; 11] = [
    &ROBOT_DESCRIPTION,
    &JOINT_STATES,
    &IMU,
    &FOOT_WRENCH[0],
    &FOOT_WRENCH[1],
    &TF_STATIC,
    &TF,
    &MARKERS,
    &TRUTH_TF,
    &TRUTH_MARKERS,
    &ROSOUT,
];

impl Standard {
    /// Quality of service with which players send it again: what is sent once waits for those who come later.
    pub(crate) fn quality(&self) -> &'static str {
        let once = [TF_STATIC.topic, ROBOT_DESCRIPTION.topic].contains(&self.topic);
        if once { TRANSIENT_LOCAL } else { "" }
    }
}

const TRANSIENT_LOCAL: &str = "- history: 1\n  depth: 1\n  reliability: 1\n  durability: 1\n  \
    deadline:\n    sec: 9223372036\n    nsec: 854775807\n  lifespan:\n    sec: 9223372036\n    nsec: 854775807\n  \
    liveliness: 1\n  liveliness_lease_duration:\n    sec: 9223372036\n    nsec: 854775807\n  \
    avoid_ros_namespace_conventions: false\n";
