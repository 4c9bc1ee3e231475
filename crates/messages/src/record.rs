//! Records and how to walk over their fields: one declaration serves shared memory, `topic echo` and the log.

use curves::{Path, Polyline};

/// A fixed-size message of one topic.
///
/// Declared with [`record!`](crate::record!), which writes the struct and this description of it.
pub trait Record: Field + Send + Sync + 'static {
    /// Name of the type, also of its `.msg` definition.
    const NAME: &'static str;

    /// The record with all fields zero.
    fn empty() -> Self;

    /// Tick, stamp and epoch.
    fn header(&self) -> &Header;

    /// Tick, stamp and epoch, to be filled by the writer.
    fn header_mut(&mut self) -> &mut Header;
}

/// A value that knows its parts.
pub trait Field: Copy {
    /// The ROS 2 interface type of this value (`float64`, `float64[32]`, `Wrench`), for definitions and for the
    /// schema hash.
    fn type_name() -> String;

    /// Tells `define` every struct this value is made of: (name, lines of `type field`), inner ones first.
    fn describe(define: &mut dyn FnMut(&'static str, Vec<(String, &'static str)>));

    /// Shows every part of the value, in the order of declaration.
    fn visit(&self, visit: &mut dyn Visit);

    /// Puts the value together again from its parts, in the order of declaration: the inverse of [`Field::visit`].
    fn read(read: &mut dyn Read) -> Self;
}

/// Hands out the parts of a record in the order of declaration. It never fails: what has run dry hands out zeros and
/// remembers it.
pub trait Read {
    /// A scalar `float64`.
    fn f64(&mut self) -> f64;
    /// A scalar `uint64`.
    fn u64(&mut self) -> u64;
    /// A scalar `uint32`.
    fn u32(&mut self) -> u32;
    /// A scalar `int32`.
    fn i32(&mut self) -> i32 {
        self.u32() as i32
    }
    /// A scalar `uint8`.
    fn u8(&mut self) -> u8;
}

/// Receives the parts of a record in the order of declaration.
pub trait Visit {
    /// A scalar `float64`.
    fn f64(&mut self, value: f64);
    /// A scalar `uint64`.
    fn u64(&mut self, value: u64);
    /// A scalar `uint32`.
    fn u32(&mut self, value: u32);
    /// A scalar `int32`.
    fn i32(&mut self, value: i32) {
        self.u32(value as u32);
    }
    /// A scalar `uint8`.
    fn u8(&mut self, value: u8);
    /// What stands in the documentation of the part that begins next: its unit in brackets first.
    fn about(&mut self, _text: &'static str) {}
    /// A named part of a struct begins; it ends with [`Visit::end`].
    fn field(&mut self, _name: &'static str) {}
    /// A fixed-size array begins; it ends with [`Visit::end`].
    fn array(&mut self, _len: usize) {}
    /// An array of as many elements as there are begins; it ends with [`Visit::end`].
    fn sequence(&mut self, len: usize) {
        self.array(len);
    }
    /// The innermost part that began ends.
    fn end(&mut self) {}
}

macro_rules! scalar {
    ($($t:ident $ros:literal)*) => {$(
        impl Field for $t {
            fn type_name() -> String { $ros.into() }
            fn describe(_: &mut dyn FnMut(&'static str, Vec<(String, &'static str)>)) {}
            fn visit(&self, visit: &mut dyn Visit) { visit.$t(*self); }
            fn read(read: &mut dyn Read) -> Self { read.$t() }
        }
    )*};
}
scalar!(f64 "float64" u64 "uint64" u32 "uint32" i32 "int32" u8 "uint8");

impl<T: Field, const N: usize> Field for [T; N] {
    /// Arrays of arrays are flattened, as the ROS 2 interface language wants it.
    fn type_name() -> String {
        let inner = T::type_name();
        match inner.split_once('[') {
            Some((scalar, rest)) => {
                let m: usize = rest.trim_end_matches(']').parse().expect("array length");
                format!("{scalar}[{}]", N * m)
            }
            None => format!("{inner}[{N}]"),
        }
    }
    fn describe(define: &mut dyn FnMut(&'static str, Vec<(String, &'static str)>)) {
        T::describe(define);
    }
    fn visit(&self, visit: &mut dyn Visit) {
        visit.array(N);
        for x in self {
            x.visit(visit);
        }
        visit.end();
    }
    fn read(read: &mut dyn Read) -> Self {
        std::array::from_fn(|_| T::read(read))
    }
}

/// Declares a `#[repr(C)]` record or a part of one, and its [`Field`](crate::Field) description.
///
/// With `record NAME` the struct must have a field `header: Header` and also becomes a [`Record`](crate::Record).
#[macro_export]
macro_rules! record {
    ($(#[$meta:meta])* part $name:ident { $($(#[doc = $about:literal])* $field:ident: $type:ty,)* }) => {
        $(#[$meta])*
        #[repr(C)]
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct $name { $($(#[doc = $about])* pub $field: $type,)* }

        impl $crate::record::Field for $name {
            fn type_name() -> String { stringify!($name).into() }
            fn describe(define: &mut dyn FnMut(&'static str, Vec<(String, &'static str)>)) {
                $(<$type as $crate::record::Field>::describe(define);)*
                define(stringify!($name), vec![
                    $((<$type as $crate::record::Field>::type_name(), stringify!($field)),)*
                ]);
            }
            fn visit(&self, visit: &mut dyn $crate::record::Visit) {
                $(
                    visit.about(concat!($($about),*));
                    visit.field(stringify!($field));
                    self.$field.visit(visit);
                    visit.end();
                )*
            }
            fn read(read: &mut dyn $crate::record::Read) -> Self {
                Self { $($field: <$type as $crate::record::Field>::read(read),)* }
            }
        }

        impl $crate::record::Zero for $name {
            const ZERO: Self = Self { $($field: <$type as $crate::record::Zero>::ZERO,)* };
        }

        impl Default for $name {
            fn default() -> Self { <Self as $crate::record::Zero>::ZERO }
        }
    };
    ($(#[$meta:meta])* record $name:ident { $($body:tt)* }) => {
        $crate::record! { $(#[$meta])* part $name { $($body)* } }

        impl $crate::record::Record for $name {
            const NAME: &'static str = stringify!($name);
            fn empty() -> Self { <Self as $crate::record::Zero>::ZERO }
            fn header(&self) -> &$crate::record::Header { &self.header }
            fn header_mut(&mut self) -> &mut $crate::record::Header { &mut self.header }
        }

    };
}

/// The value with all parts zero.
pub trait Zero {
    /// All parts zero.
    const ZERO: Self;
}
macro_rules! zero { ($($t:ty = $z:expr),*) => {$(impl Zero for $t { const ZERO: Self = $z; })*}; }
zero!(f64 = 0.0, u64 = 0, u32 = 0, i32 = 0, u8 = 0);
impl<T: Zero, const N: usize> Zero for [T; N] {
    const ZERO: Self = [T::ZERO; N];
}

record! {
    /// Time and writer of a record. The first field of every record.
    part Header {
        /// \[1\] Number of the bus cycle the record belongs to; lowlevel counts it.
        tick: u64,
        /// \[ns\] Time stamp of that cycle, made by lowlevel, the master of time.
        stamp_ns: u64,
        /// \[1\] Which writer of the topic, from 1: tells a restarted one from the one before it. Filled in by the port.
        epoch: u64,
    }
}

record! {
    /// A force and a moment about a named point, acting on the robot.
    part Wrench {
        /// \[N\]
        force: [f64; 3],
        /// \[N m\]
        moment: [f64; 3],
    }
}

/// Curves are logged as what they are made of.
impl<const D: usize, const N: usize> Field for Path<D, N> {
    fn type_name() -> String {
        Self::name().into()
    }
    fn describe(define: &mut dyn FnMut(&'static str, Vec<(String, &'static str)>)) {
        define(
            Self::name(),
            vec![
                (u64::type_name(), "pieces"),
                (f64::type_name(), "start"),
                (<[f64; D]>::type_name(), "origin"),
                (<[f64; N]>::type_name(), "ends"),
                (<[[[f64; 6]; D]; N]>::type_name(), "coefficients"),
            ],
        );
    }
    fn visit(&self, visit: &mut dyn Visit) {
        visit.field("pieces");
        self.pieces.visit(visit);
        visit.end();
        visit.field("start");
        self.start.visit(visit);
        visit.end();
        visit.field("origin");
        self.origin.visit(visit);
        visit.end();
        visit.field("ends");
        self.ends.visit(visit);
        visit.end();
        visit.field("coefficients");
        self.coefficients.visit(visit);
        visit.end();
    }
    fn read(read: &mut dyn Read) -> Self {
        Self {
            pieces: Field::read(read),
            start: Field::read(read),
            origin: Field::read(read),
            ends: Field::read(read),
            coefficients: Field::read(read),
        }
    }
}
trait CurveName {
    fn name() -> &'static str;
}
impl<const D: usize, const N: usize> CurveName for Path<D, N> {
    fn name() -> &'static str {
        match (D, N) {
            (1, 16) => "Path1x16",
            (1, 40) => "Path1x40",
            (3, 16) => "Path3x16",
            (3, 96) => "Path3x96",
            (4, 32) => "Path4x32",
            _ => "Path",
        }
    }
}
impl<const D: usize, const N: usize> Zero for Path<D, N> {
    const ZERO: Self = Self::resting(0.0, [0.0; D]);
}

impl<const D: usize, const N: usize> Field for Polyline<D, N> {
    fn type_name() -> String {
        format!("Polyline{D}")
    }
    fn describe(define: &mut dyn FnMut(&'static str, Vec<(String, &'static str)>)) {
        let name = if D == 2 { "Polyline2" } else { "Polyline1" };
        define(
            name,
            vec![
                (u64::type_name(), "points"),
                (<[f64; N]>::type_name(), "times"),
                (<[[f64; D]; N]>::type_name(), "values"),
            ],
        );
    }
    fn visit(&self, visit: &mut dyn Visit) {
        visit.field("points");
        self.points.visit(visit);
        visit.end();
        visit.field("times");
        self.times.visit(visit);
        visit.end();
        visit.field("values");
        self.values.visit(visit);
        visit.end();
    }
    fn read(read: &mut dyn Read) -> Self {
        Self { points: Field::read(read), times: Field::read(read), values: Field::read(read) }
    }
}
impl<const D: usize, const N: usize> Zero for Polyline<D, N> {
    const ZERO: Self = Self::empty();
}
