use crate::blocks::Timer;

pub struct Program {
    pub go: bool,
    pub n: i32,
    timers: [Timer; 24],
}

impl Program {
    pub const NEW: Self = Self { go: false, n: 0, timers: [Timer::NEW; 24] };

    pub fn scan(&mut self, now: i64) {
        let (mut input, mut time) = (self.go, 5_000_000);
        for [on, off, pulse] in self.timers.as_chunks_mut().0 {
            on.on(input, time, now);
            off.off(on.q, time + 1_000_000, now);
            pulse.pulse(off.q, time + 2_000_000, now);
            (input, time) = (pulse.q, time + 3_000_000);
        }
        self.n = self.n.wrapping_add(i32::from(input));
    }
}
