//! Regular triangulations of the domain: cubes, each cut into five or six tetrahedra.
//!
//! Two cuts of a cube without new vertices are in use (lecture notes, chapter 10): six tetrahedra
//! around a diagonal, each a path along the three axes (Kuhn), or five, one regular in the middle.
//! Six fit together when neighbours are translated (CFK) or reflected; five only reflected.

/// How a cube is cut.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum CubeCut {
    /// A regular tetrahedron on four corners and one at each of the other corners.
    Five,
    /// Six Kuhn simplices around the diagonal from corner 0 to corner 7.
    Six,
}

impl CubeCut {
    /// The tetrahedra as corners of the cube; bit a of a corner is its coordinate on axis a.
    #[must_use]
    pub fn tetrahedra(self) -> &'static [[u8; 4]] {
        match self {
            Self::Five => &[
                [0, 3, 5, 6],
                [1, 0, 3, 5],
                [2, 0, 3, 6],
                [4, 0, 5, 6],
                [7, 3, 5, 6],
            ],
            Self::Six => &[
                [0, 1, 3, 7],
                [0, 1, 5, 7],
                [0, 2, 3, 7],
                [0, 2, 6, 7],
                [0, 4, 5, 7],
                [0, 4, 6, 7],
            ],
        }
    }
}

/// How neighbouring cubes are cut.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Pattern {
    /// Six tetrahedra, all cubes alike: the CFK triangulation (K₁).
    Translated,
    /// Six tetrahedra, neighbours mirrored (Todd's J₁): what bisection makes of the domain's six
    /// simplices after 3, 6, 9 … levels.
    Reflected,
    /// Five tetrahedra, neighbours mirrored.
    Five,
}

impl Pattern {
    /// The cut of one cube.
    #[must_use]
    pub fn cut(self) -> CubeCut {
        match self {
            Self::Translated | Self::Reflected => CubeCut::Six,
            Self::Five => CubeCut::Five,
        }
    }

    /// Which axes are mirrored in the cube at these integer coordinates, as bits.
    ///
    /// Mirrored cuts have corner 0 where all coordinates are odd.
    #[must_use]
    pub(super) fn mirrors(self, cube: [u32; 3]) -> u8 {
        match self {
            Self::Translated => 0,
            Self::Reflected | Self::Five => {
                (0..3).map(|axis| (!cube[axis] as u8 & 1) << axis).sum()
            }
        }
    }

    /// The vertices of a cube's tetrahedra in integer coordinates.
    pub(super) fn tetrahedra(self, cube: [u32; 3]) -> impl Iterator<Item = [[u32; 3]; 4]> {
        let mirrors = self.mirrors(cube);
        let corner = move |corner: u8| {
            let bits = corner ^ mirrors;
            [0, 1, 2].map(|axis| cube[axis] + u32::from(bits >> axis & 1))
        };
        self.cut().tetrahedra().iter().map(move |t| t.map(corner))
    }
}
