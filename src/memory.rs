//! What the operating system tells about memory, where it does (Linux).

use crate::values::Bytes;
use std::fs;

/// The most memory that this process has held at any time, in bytes.
pub(crate) fn peak_bytes() -> Option<u64> {
    field(&fs::read_to_string("/proc/self/status").ok()?, "VmHWM:")
}

/// Memory allowed where the machine does not tell how much it has.
const FALLBACK: u64 = 4 << 30;

/// What may be used, in bytes: what was asked for, or three quarters of the machine's.
pub(crate) fn allowed_bytes(asked: Option<Bytes>) -> u64 {
    let asked = asked.map(|Bytes(bytes)| bytes);
    let most = asked.or_else(|| Some(physical_bytes()? / 4 * 3));
    most.unwrap_or(FALLBACK)
}

/// The memory of the machine, in bytes.
pub(crate) fn physical_bytes() -> Option<u64> {
    field(&fs::read_to_string("/proc/meminfo").ok()?, "MemTotal:")
}

/// A line such as `VmHWM:     1234 kB`, in bytes.
fn field(text: &str, name: &str) -> Option<u64> {
    let line = text.lines().find_map(|line| line.strip_prefix(name))?;
    let number: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    number.checked_mul(1024)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_are_in_kibibytes() {
        let text = "Name:\tx\nVmHWM:\t    12 kB\nVmRSS:\t 9 kB\n";
        assert_eq!(field(text, "VmHWM:"), Some(12 << 10));
        assert_eq!(field(text, "Name:"), None);
        assert_eq!(field(text, "VmPeak:"), None);
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn linux_tells_both() {
        assert!(peak_bytes().unwrap() < physical_bytes().unwrap());
    }
}
