//! OFF: a header, the counts, a line for each vertex and each face.

use super::Polygons;
use glam::DVec3;

/// Reads the text of an OFF file; colours are ignored.
pub(super) fn read(bytes: &[u8]) -> Result<Polygons, String> {
    let text = String::from_utf8_lossy(bytes);
    let lines = (1_usize..).zip(text.lines());
    let mut lines = lines
        .map(|(number, line)| (number, line.split('#').next().unwrap_or_default().trim()))
        .filter(|(_, line)| !line.is_empty());
    let (number, first) = lines.next().ok_or("the file is empty")?;
    // The counts may follow the header in the same line.
    let after = first.strip_prefix('\u{feff}').unwrap_or(first);
    let after = after
        .strip_prefix("OFF")
        .or_else(|| after.strip_prefix("COFF"));
    let after = after.ok_or_else(|| format!("line {number}: no OFF header"))?;
    let (number, counts) = if after.trim().is_empty() {
        lines.next().ok_or("the counts are missing")?
    } else {
        (number, after)
    };
    let mut counts = counts.split_whitespace().map(str::parse::<usize>);
    let (Some(Ok(vertex_count)), Some(Ok(face_count))) = (counts.next(), counts.next()) else {
        return Err(format!(
            "line {number}: the counts of vertices and faces are no numbers"
        ));
    };
    let mut vertices = Vec::new();
    for (number, line) in lines.by_ref().take(vertex_count) {
        let numbers = line.split_whitespace().map(str::parse::<f64>);
        let numbers: Vec<f64> = numbers.take(3).filter_map(Result::ok).collect();
        match numbers[..] {
            [x, y, z] if x.is_finite() && y.is_finite() && z.is_finite() => {
                vertices.push(DVec3::new(x, y, z));
            }
            _ => return Err(format!("line {number}: a vertex needs three numbers")),
        }
    }
    let mut faces = Vec::new();
    for (number, line) in lines.take(face_count) {
        let mut words = line.split_whitespace().map(str::parse::<usize>);
        let Some(Ok(corners)) = words.next() else {
            return Err(format!(
                "line {number}: a face begins with its number of corners"
            ));
        };
        let position = |word: Option<Result<usize, _>>| {
            let at: usize = word.and_then(Result::ok)?;
            vertices.get(at).copied()
        };
        // As many as are missing end the loop at the first.
        let face: Option<Vec<DVec3>> = (0..corners).map(|_| position(words.next())).collect();
        faces.push(face.ok_or_else(|| format!("line {number}: a corner of the face is missing"))?);
    }
    if vertices.len() < vertex_count || faces.len() < face_count {
        return Err(format!(
            "the file ends after {} of {vertex_count} vertices and {} of {face_count} faces",
            vertices.len(),
            faces.len()
        ));
    }
    Ok(faces)
}
