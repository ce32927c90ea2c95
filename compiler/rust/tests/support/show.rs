// A byte as it is compared: zero in padding and after a string's end.
fn show(byte: u8, mask: u8, last: &mut [u8; 2], left: &mut u16) -> u8 {
    if mask == 2 {
        let held = *left > 0;
        *left = left.saturating_sub(1);
        return if held { byte } else { 0 };
    }
    *last = [last[1], byte];
    *left = u16::from_ne_bytes(*last);
    if mask == 0 { 0 } else { byte }
}
