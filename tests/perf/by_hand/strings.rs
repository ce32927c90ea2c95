/// A STRING of 80 characters.
#[derive(Clone, Copy)]
struct Text {
    len: u8,
    bytes: [u8; 80],
}

impl Text {
    const NEW: Self = Self { len: 0, bytes: [0; 80] };

    #[inline]
    fn get(&self) -> &[u8] {
        &self.bytes[..usize::from(self.len).min(80)]
    }

    #[inline]
    fn push(&mut self, text: &[u8]) {
        let start = usize::from(self.len).min(80);
        let len = text.len().min(80 - start);
        self.bytes[start..start + len].copy_from_slice(&text[..len]);
        self.len = (start + len) as u8;
    }

    #[inline]
    fn set(&mut self, text: &[u8]) {
        self.len = 0;
        self.push(text);
    }
}

fn find(text: &[u8], part: &[u8]) -> usize {
    if part.is_empty() || part.len() > text.len() {
        return 0;
    }
    for i in 0..=text.len() - part.len() {
        if text[i] == part[0] && &text[i..i + part.len()] == part {
            return i + 1;
        }
    }
    0
}

pub struct Program {
    pub pick: bool,
    a: Text,
    b: Text,
    c: Text,
    d: Text,
    e: Text,
    pub tot: i32,
}

impl Program {
    pub const NEW: Self =
        Self { pick: false, a: Text::NEW, b: Text::NEW, c: Text::NEW, d: Text::NEW, e: Text::NEW, tot: 0 };

    pub fn scan(&mut self, _: i64) {
        self.a.set(if self.pick { b"pump station alpha" } else { b"valve block beta" });
        self.b.set(b"status: ");
        for _ in 0..10 {
            self.c.set(self.b.get());
            self.c.push(self.a.get());
            let c = self.c.get();
            self.d.set(&c[..c.len().min(12)]);
            let start = c.len().min(8);
            self.e.set(&c[start..c.len().min(start + 6)]);
            let found = find(c, self.e.get());
            self.d.push(self.e.get());
            if self.d.get() == c {
                self.tot = self.tot.wrapping_add(1);
            }
            self.tot = self.tot.wrapping_add((found + c.len() + self.d.get().len()) as i32);
            let old = self.b;
            let old = old.get();
            self.b.set(&old[..old.len().min(2)]);
            self.b.push(b"xy");
            self.b.push(&old[old.len().min(4)..]);
        }
        if self.tot > 1_000_000_000 {
            self.tot = 0;
        }
    }
}
