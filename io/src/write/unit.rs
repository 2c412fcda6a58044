//! What a model unit is in the world.

/// A unit of length; these are the units of 3MF.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Unit {
    /// A thousandth of a millimetre.
    Micron,
    /// What slicers take numbers for.
    #[default]
    Millimetre,
    /// Ten millimetres.
    Centimetre,
    /// 25.4 millimetres.
    Inch,
    /// Twelve inches.
    Foot,
    /// The unit of glTF.
    Metre,
}

impl Unit {
    /// Its length in metres, as the 32-bit number that glTF stores.
    pub fn metres(self) -> f32 {
        match self {
            Self::Micron => 1e-6,
            Self::Millimetre => 1e-3,
            Self::Centimetre => 1e-2,
            Self::Inch => 0.0254,
            Self::Foot => 0.3048,
            Self::Metre => 1.0,
        }
    }

    /// Its length in millimetres.
    pub fn millimetres(self) -> f64 {
        match self {
            Self::Micron => 1e-3,
            Self::Millimetre => 1.0,
            Self::Centimetre => 10.0,
            Self::Inch => 25.4,
            Self::Foot => 304.8,
            Self::Metre => 1000.0,
        }
    }

    /// Its name as 3MF spells it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Micron => "micron",
            Self::Millimetre => "millimeter",
            Self::Centimetre => "centimeter",
            Self::Inch => "inch",
            Self::Foot => "foot",
            Self::Metre => "meter",
        }
    }
}
