//! The machine's fonts, for models that write text.

use fontdb::{Database, Family, Query, Source, Stretch, Style, Weight};
use io::read::{FileRefusal, FontFile};
use std::sync::OnceLock;

/// What stands for a font that OpenSCAD brings along, and for those that are not here.
const USUAL: [Family<'static>; 4] = [
    Family::Name("Liberation Sans"),
    Family::SansSerif,
    Family::Name("DejaVu Sans"),
    Family::Name("Arial"),
];

/// The fonts, found once.
fn fonts() -> &'static Database {
    static FONTS: OnceLock<Database> = OnceLock::new();
    FONTS.get_or_init(|| {
        let mut fonts = Database::new();
        fonts.load_system_fonts();
        fonts
    })
}

/// The font that OpenSCAD would call `wanted`, as in `DejaVu Sans:style=Bold`, or what comes
/// nearest.
pub(crate) fn find(wanted: &str) -> Result<FontFile, FileRefusal> {
    let fonts = fonts();
    let mut parts = wanted.split(':');
    let family = parts.next().unwrap_or_default().trim();
    let style = parts.find_map(|part| part.trim().strip_prefix("style="));
    let query = |families: &[Family<'_>]| {
        let (weight, stretch, style) = traits(style.unwrap_or_default());
        fonts.query(&Query {
            families,
            weight,
            stretch,
            style,
        })
    };
    let named = match family.to_ascii_lowercase().as_str() {
        "" => query(&USUAL),
        "sans" | "sans-serif" => query(&[Family::SansSerif, Family::Name("DejaVu Sans")]),
        "serif" => query(&[Family::Serif, Family::Name("DejaVu Serif")]),
        "mono" | "monospace" => query(&[Family::Monospace, Family::Name("DejaVu Sans Mono")]),
        _ => {
            // Names are compared as written; OpenSCAD's users write them in any case.
            let mut names = fonts.faces().flat_map(|face| &face.families);
            let name = names.find(|(name, _)| name.eq_ignore_ascii_case(family));
            name.and_then(|(name, _)| query(&[Family::Name(name)]))
        }
    };
    let is_substitute = named.is_none();
    let any = || fonts.faces().next().map(|face| face.id);
    let found = named.or_else(|| query(&USUAL)).or_else(any);
    let face = found.and_then(|id| fonts.face(id)).ok_or_else(none)?;
    let bytes = match &face.source {
        Source::File(path) => std::fs::read(path).map_err(|cause| FileRefusal {
            message: format!("cannot read {}: {cause}", path.display()),
            remedy: "install another font".to_owned(),
        })?,
        Source::Binary(bytes) => bytes.as_ref().as_ref().to_vec(),
    };
    Ok(FontFile {
        bytes,
        index: face.index,
        name: face.post_script_name.clone(),
        is_substitute,
    })
}

fn none() -> FileRefusal {
    FileRefusal {
        message: "there is none on this machine".to_owned(),
        remedy: "install one, such as fonts-liberation, or let OpenSCAD make a mesh of the \
                 extruded text, as in openscad -o text.off text.scad, and write \
                 import(\"text.off\") in its place"
            .to_owned(),
    }
}

/// What the words of a style ask for.
fn traits(style: &str) -> (Weight, Stretch, Style) {
    let style = style.to_ascii_lowercase().replace([' ', '-'], "");
    let has = |word: &str| style.contains(word);
    let weight = match () {
        () if has("thin") => Weight::THIN,
        () if has("extralight") || has("ultralight") => Weight::EXTRA_LIGHT,
        () if has("light") => Weight::LIGHT,
        () if has("medium") => Weight::MEDIUM,
        () if has("semibold") || has("demibold") => Weight::SEMIBOLD,
        () if has("extrabold") || has("ultrabold") => Weight::EXTRA_BOLD,
        () if has("bold") => Weight::BOLD,
        () if has("black") || has("heavy") => Weight::BLACK,
        () => Weight::NORMAL,
    };
    let stretch = match () {
        () if has("semicondensed") => Stretch::SemiCondensed,
        () if has("condensed") || has("narrow") => Stretch::Condensed,
        () if has("expanded") => Stretch::Expanded,
        () => Stretch::Normal,
    };
    let slant = match () {
        () if has("italic") => Style::Italic,
        () if has("oblique") => Style::Oblique,
        () => Style::Normal,
    };
    (weight, stretch, slant)
}
