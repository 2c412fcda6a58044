//! Bytes to text: UTF-8, and clear words about everything else.

use super::diagnostic::{Diagnostic, Source};

/// The text of a file that should be UTF-8.
///
/// A byte order mark stays; readers skip it. `name` stands for the file in complaints.
///
/// # Errors
/// UTF-16 and UTF-32, with the command that converts them; else the first byte that is not UTF-8.
pub fn decode(bytes: Vec<u8>, name: &str) -> Result<String, Diagnostic> {
    if let Some(encoding) = wide_encoding(&bytes) {
        let shown = if name.starts_with(['-', '<']) {
            "model.csg"
        } else {
            name
        };
        let message = format!("the file is {encoding} text, expected UTF-8");
        let remedy = format!("convert it: iconv -f {encoding} -t UTF-8 {shown} > utf8.csg");
        return Err(Source::new("", name).diagnostic(0..0, message, remedy));
    }
    String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        let bytes = error.as_bytes();
        let before = bytes.get(..at).unwrap_or_default();
        let before = String::from_utf8_lossy(before);
        let byte = bytes.get(at).copied().unwrap_or_default();
        let message = format!("byte 0x{byte:02X} at offset {at} is not UTF-8");
        let remedy = if bytes.contains(&0) {
            "the file is binary, or damaged"
        } else {
            "save the file as UTF-8"
        };
        Source::new(&before, name).diagnostic(at..at, message, remedy.to_owned())
    })
}

/// Recognises UTF-16 and UTF-32 by their marks, or by the zero bytes that ASCII text has there.
fn wide_encoding(bytes: &[u8]) -> Option<&'static str> {
    let ascii = |b: &u8| matches!(b, b' '..=b'~' | b'\n' | b'\r' | b'\t');
    match bytes {
        [0xFF, 0xFE, 0, 0, ..] | [0, 0, 0xFE, 0xFF, ..] => Some("UTF-32"),
        [0xFF, 0xFE, ..] | [0xFE, 0xFF, ..] => Some("UTF-16"),
        [a, 0, b, 0, ..] if ascii(a) && ascii(b) => Some("UTF-16LE"),
        [0, a, 0, b, ..] if ascii(a) && ascii(b) => Some("UTF-16BE"),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn utf16(text: &str, bytes: fn(u16) -> [u8; 2]) -> Vec<u8> {
        text.encode_utf16().flat_map(bytes).collect()
    }

    #[test]
    fn utf8_passes_with_and_without_mark() {
        assert_eq!(decode(b"cube();".to_vec(), "a").unwrap(), "cube();");
        let marked = b"\xEF\xBB\xBFcube();".to_vec();
        assert_eq!(decode(marked, "a").unwrap(), "\u{feff}cube();");
        assert_eq!(decode(Vec::new(), "a").unwrap(), "");
    }

    #[test]
    fn wide_text_is_told_with_the_command_that_converts_it() {
        for (bytes, encoding) in [
            (utf16("\u{feff}cube();", u16::to_le_bytes), "UTF-16"),
            (utf16("\u{feff}cube();", u16::to_be_bytes), "UTF-16"),
            (utf16("cube();", u16::to_le_bytes), "UTF-16LE"),
            (utf16("cube();", u16::to_be_bytes), "UTF-16BE"),
        ] {
            let found = decode(bytes, "a.csg").unwrap_err().to_string();
            let expected = format!(
                "a.csg:1:1: the file is {encoding} text, expected UTF-8 \
                 (convert it: iconv -f {encoding} -t UTF-8 a.csg > utf8.csg)"
            );
            assert_eq!(found, expected);
        }
    }

    #[test]
    fn the_first_foreign_byte_is_located() {
        let found = decode(b"cube();\n// caf\xE9".to_vec(), "a.csg").unwrap_err();
        assert_eq!(
            found.to_string(),
            "a.csg:2:7: byte 0xE9 at offset 14 is not UTF-8 (save the file as UTF-8)"
        );
    }
}
