//! From where VISUAL looks: `sisproj.dat`, eleven numbers in text (thesis A.4.3).

use super::Error;
use super::text::{end, words};
use glam::DVec3;

/// The projective system: a plane through the reference point, seen from a distance.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Projection {
    /// PR: the point of the projection plane that is looked at.
    pub reference: DVec3,
    /// DO: the direction in which the observer looks, not zero.
    pub direction: DVec3,
    /// DP: the observer's distance from the projection plane, positive.
    pub distance: f64,
    /// JP: the window in the projection plane, xmin, ymin, xmax, ymax from the reference point.
    pub window: [f64; 4],
}

/// Reads a projective system.
///
/// # Errors
/// What is missing, no number, or makes no sense, with its place.
pub fn read(text: &str) -> Result<Projection, Error> {
    let mut found = words(text);
    let mut numbers = [0.0_f64; 11];
    let mut places = [end(text); 11];
    for (number, place) in numbers.iter_mut().zip(&mut places) {
        let expected = "a number (PRx PRy PRz DOx DOy DOz DP JPxmin JPymin JPxmax JPymax)";
        let word = found.next().unwrap_or(end(text));
        *number = word.parse(expected)?;
        *place = word;
        if !number.is_finite() {
            return Err(word.error("a finite number"));
        }
    }
    if let Some(word) = found.next() {
        return Err(word.error("the end of the file after eleven numbers"));
    }
    let [px, py, pz, dx, dy, dz, distance, x0, y0, x1, y1] = numbers;
    let [.., at_distance, _, _, at_x1, at_y1] = places;
    let direction = DVec3::new(dx, dy, dz);
    if direction.try_normalize().is_none() {
        return Err(places[3].error("a direction that is not zero"));
    }
    if distance <= 0.0 {
        return Err(at_distance.error("a positive distance"));
    }
    if x1 <= x0 {
        return Err(at_x1.error("JPxmax above JPxmin"));
    }
    if y1 <= y0 {
        return Err(at_y1.error("JPymax above JPymin"));
    }
    Ok(Projection {
        reference: DVec3::new(px, py, pz),
        direction,
        distance,
        window: [x0, y0, x1, y1],
    })
}

/// The file's text.
#[must_use]
pub fn write(system: &Projection) -> String {
    let Projection {
        reference: r,
        direction: d,
        distance,
        window: [x0, y0, x1, y1],
    } = system;
    format!(
        "{} {} {}\n{} {} {}\n{distance}\n{x0} {y0} {x1} {y1}\n",
        r.x, r.y, r.z, d.x, d.y, d.z
    )
}
