//! A lowered solid holds the same points as the model it was built from.

use crate::oracle::{
    self, affine, any_shape, bounded_shape, clear_value, model, projective, tree, vector,
};
use csg::{Aabb, Error, Solid};
use glam::DVec3;
use proptest::prelude::*;

const CLIP: Aabb = Aabb {
    min: DVec3::new(-2.1, -2.3, -1.9),
    max: DVec3::new(2.2, 2.0, 2.4),
};

fn in_clip(p: DVec3) -> bool {
    p.cmpge(CLIP.min).all() && p.cmple(CLIP.max).all()
}

fn agree(tree: &oracle::Tree, points: &[DVec3]) -> Result<(), TestCaseError> {
    let model = model(tree);
    let solid = Solid::build(&model, Some(CLIP)).unwrap();
    prop_assert!(solid.extent.is_empty() || solid.extent.is_finite());
    for &p in points.iter().filter(|p| in_clip(**p)) {
        if let Some(value) = clear_value(&model, p) {
            prop_assert_eq!(solid.contains(p), value, "at {}", p);
            if value {
                let inside = p.cmpge(solid.extent.min).all() && p.cmple(solid.extent.max).all();
                prop_assert!(inside, "{} outside {:?}", p, solid.extent);
            }
        }
    }
    Ok(())
}

fn points() -> impl Strategy<Value = Vec<DVec3>> {
    proptest::collection::vec(vector(-2.2, 2.2), 60)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn affine_trees(t in tree(any_shape(), affine()), points in points()) {
        agree(&t, &points)?;
    }

    #[test]
    fn projective_trees(t in tree(any_shape(), projective()), points in points()) {
        agree(&t, &points)?;
    }

    #[test]
    fn unclipped_trees(t in tree(bounded_shape(), affine()), points in points()) {
        let model = model(&t);
        match Solid::build(&model, None) {
            Ok(solid) => {
                prop_assert!(!solid.clipped);
                for p in points {
                    if let Some(value) = clear_value(&model, p) {
                        prop_assert_eq!(solid.contains(p), value);
                    }
                }
            }
            // Complements of bounded shapes are unbounded.
            Err(error) => prop_assert_eq!(error, Error::Unbounded),
        }
    }
}
