//! Colours that people with any kind of colour vision can tell apart (Okabe and Ito, 2008).

/// Red, green, blue, opacity; 0..255.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Color(pub u8, pub u8, pub u8, pub u8);

/// Text and axes.
pub const BLACK: Color = Color(0x22, 0x22, 0x22, 0xff);
/// Secondary text.
pub const GREY: Color = Color(0x77, 0x77, 0x77, 0xff);
/// Grid.
pub const LIGHT: Color = Color(0xdd, 0xdd, 0xdd, 0xff);
/// Background.
pub(crate) const WHITE: Color = Color(0xff, 0xff, 0xff, 0xff);
/// First series.
pub const BLUE: Color = Color(0x00, 0x72, 0xb2, 0xff);
/// Second series.
pub const VERMILION: Color = Color(0xd5, 0x5e, 0x00, 0xff);
/// Third series.
pub const GREEN: Color = Color(0x00, 0x9e, 0x73, 0xff);
/// Fourth series.
pub const PURPLE: Color = Color(0xcc, 0x79, 0xa7, 0xff);
/// Fifth series.
pub const SKY: Color = Color(0x56, 0xb4, 0xe9, 0xff);
/// Sixth series.
pub const ORANGE: Color = Color(0xe6, 0x9f, 0x00, 0xff);

impl Color {
    /// The same colour, more transparent.
    pub const fn faint(self, opacity: u8) -> Self {
        Self(self.0, self.1, self.2, opacity)
    }
}
