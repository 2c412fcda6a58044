//! Numbers out of glTF's buffers: every range is checked before it is read.

use super::broken;
use crate::read::mesh::MeshError;
use glam::DVec3;
use gltf_json as json;
use json::accessor::{ComponentType, Type, sparse};
use json::validation::{Checked, USize64};
use json::{Accessor, Root};

/// The description and its one buffer.
pub(super) struct Buffers<'a> {
    root: &'a Root,
    binary: &'a [u8],
}

impl<'a> Buffers<'a> {
    pub(super) fn new(root: &'a Root, binary: &'a [u8]) -> Self {
        Self { root, binary }
    }

    /// An accessor of three components a vertex, at most `limit` of them.
    pub(super) fn positions(
        &self,
        accessor: usize,
        place: &str,
        limit: usize,
    ) -> Result<Vec<DVec3>, MeshError> {
        let (accessor, kind) = self.accessor(accessor, Type::Vec3, place, limit)?;
        let size = 3 * kind.size();
        let read = |bytes: &[u8]| {
            let mut numbers = bytes.chunks_exact(kind.size()).map(|b| number(kind, b));
            let mut next = || numbers.next().unwrap_or(f64::NAN);
            let position = DVec3::new(next(), next(), next());
            if accessor.normalized {
                normalized(kind, position)
            } else {
                position
            }
        };
        let mut values = self.plain(accessor, size, place, read, DVec3::ZERO)?;
        if let Some(sparse) = &accessor.sparse {
            self.replace(&mut values, sparse, size, place, read)?;
        }
        Ok(values)
    }

    /// An accessor of vertex numbers, at most `limit` of them.
    pub(super) fn indices(
        &self,
        accessor: usize,
        place: &str,
        limit: usize,
    ) -> Result<Vec<u32>, MeshError> {
        let mut values = self.indices_without_sparse(accessor, place, limit)?;
        let (accessor, kind) = self.accessor(accessor, Type::Scalar, place, limit)?;
        if let Some(sparse) = &accessor.sparse {
            let read = |bytes: &[u8]| index(bytes);
            self.replace(&mut values, sparse, kind.size(), place, read)?;
        }
        Ok(values)
    }

    /// The same before sparse replacements.
    pub(super) fn indices_without_sparse(
        &self,
        accessor: usize,
        place: &str,
        limit: usize,
    ) -> Result<Vec<u32>, MeshError> {
        let (accessor, kind) = self.accessor(accessor, Type::Scalar, place, limit)?;
        if !matches!(
            kind,
            ComponentType::U8 | ComponentType::U16 | ComponentType::U32
        ) {
            return Err(broken(place, "its indices are no unsigned numbers"));
        }
        self.plain(accessor, kind.size(), place, index, 0)
    }

    fn accessor(
        &self,
        at: usize,
        shape: Type,
        place: &str,
        limit: usize,
    ) -> Result<(&'a Accessor, ComponentType), MeshError> {
        let Some(accessor) = self.root.accessors.get(at) else {
            return Err(broken(place, &format!("there is no accessor {at}")));
        };
        if accessor.type_ != Checked::Valid(shape) {
            return Err(broken(
                place,
                &format!("accessor {at} has not the right type"),
            ));
        }
        let Checked::Valid(json::accessor::GenericComponentType(kind)) = accessor.component_type
        else {
            return Err(broken(
                place,
                &format!("accessor {at} has numbers of unknown kind"),
            ));
        };
        if length(accessor.count) > limit {
            return Err(MeshError::too_large());
        }
        Ok((accessor, kind))
    }

    /// The values in the accessor's view; `blank` ones without a view.
    fn plain<T: Copy>(
        &self,
        accessor: &Accessor,
        size: usize,
        place: &str,
        read: impl Fn(&[u8]) -> T,
        blank: T,
    ) -> Result<Vec<T>, MeshError> {
        let count = length(accessor.count);
        let Some(view) = accessor.buffer_view else {
            return Ok(vec![blank; count]);
        };
        let offset = accessor.byte_offset.map_or(0, length);
        self.values(view.value(), offset, size, count, place, read)
    }

    fn replace<T>(
        &self,
        values: &mut [T],
        sparse: &sparse::Sparse,
        size: usize,
        place: &str,
        read: impl Fn(&[u8]) -> T,
    ) -> Result<(), MeshError> {
        let count = length(sparse.count);
        let Checked::Valid(json::accessor::IndexComponentType(kind)) =
            sparse.indices.component_type
        else {
            return Err(broken(place, "its sparse indices are of unknown kind"));
        };
        let (view, offset) = (
            &sparse.indices.buffer_view,
            length(sparse.indices.byte_offset),
        );
        let places = self.values(view.value(), offset, kind.size(), count, place, index)?;
        let (view, offset) = (
            &sparse.values.buffer_view,
            length(sparse.values.byte_offset),
        );
        let replacements = self.values(view.value(), offset, size, count, place, read)?;
        for (at, value) in places.into_iter().zip(replacements) {
            let Some(old) = values.get_mut(at as usize) else {
                return Err(broken(place, "a sparse index is beyond the end"));
            };
            *old = value;
        }
        Ok(())
    }

    fn values<T>(
        &self,
        view: usize,
        offset: usize,
        size: usize,
        count: usize,
        place: &str,
        read: impl Fn(&[u8]) -> T,
    ) -> Result<Vec<T>, MeshError> {
        let Some(view) = self.root.buffer_views.get(view) else {
            return Err(broken(place, &format!("there is no buffer view {view}")));
        };
        let buffer = self.root.buffers.get(view.buffer.value());
        if view.buffer.value() != 0 || buffer.is_none_or(|buffer| buffer.uri.is_some()) {
            let message = "its data are in another file";
            let remedy = "save everything into one GLB file";
            return Err(MeshError::new(place, message, remedy));
        }
        let start = view.byte_offset.map_or(0, length);
        let end = start.checked_add(length(view.byte_length));
        let bytes = end.and_then(|end| self.binary.get(start..end));
        let bytes = bytes.and_then(|bytes| bytes.get(offset..));
        let stride = view.byte_stride.map_or(size, |stride| stride.0.max(size));
        // The last value needs no stride after it.
        let needed = count.saturating_sub(1).checked_mul(stride);
        let needed = needed.and_then(|n| n.checked_add(if count > 0 { size } else { 0 }));
        let is_there = |bytes: &&[u8]| needed.is_some_and(|needed| needed <= bytes.len());
        let Some(bytes) = bytes.filter(is_there) else {
            return Err(broken(place, "its data reach beyond the end of the buffer"));
        };
        let items = bytes.chunks(stride.max(1)).take(count);
        Ok(items
            .map(|item| read(item.get(..size).unwrap_or_default()))
            .collect())
    }
}

/// An unsigned number of 1, 2 or 4 bytes.
fn index(bytes: &[u8]) -> u32 {
    let mut all = [0; 4];
    for (to, from) in all.iter_mut().zip(bytes) {
        *to = *from;
    }
    u32::from_le_bytes(all)
}

fn number(kind: ComponentType, bytes: &[u8]) -> f64 {
    match (kind, bytes) {
        (ComponentType::I8, &[a]) => i8::from_le_bytes([a]).into(),
        (ComponentType::I16, &[a, b]) => i16::from_le_bytes([a, b]).into(),
        (ComponentType::F32, &[a, b, c, d]) => f32::from_le_bytes([a, b, c, d]).into(),
        _ => index(bytes).into(),
    }
}

/// Whole numbers that stand for a range up to 1.
fn normalized(kind: ComponentType, v: DVec3) -> DVec3 {
    match kind {
        ComponentType::I8 => (v / 127.0).max(DVec3::NEG_ONE),
        ComponentType::U8 => v / 255.0,
        ComponentType::I16 => (v / 32_767.0).max(DVec3::NEG_ONE),
        ComponentType::U16 => v / 65_535.0,
        ComponentType::U32 | ComponentType::F32 => v,
    }
}

/// A length; what no machine can hold is longer than anything.
fn length(of: USize64) -> usize {
    usize::try_from(of.0).unwrap_or(usize::MAX)
}
