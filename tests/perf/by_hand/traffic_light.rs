use crate::blocks::Timer;

#[derive(Clone, Copy)]
enum Phase {
    Red,
    RedAmber,
    Green,
    Amber,
}

pub struct Program {
    pub button: bool,
    pub waiting: bool,
    pub walk: bool,
    phase: Phase,
    t: Timer,
    pub greens: i32,
}

impl Program {
    pub const NEW: Self =
        Self { button: false, waiting: false, walk: false, phase: Phase::Red, t: Timer::NEW, greens: 0 };

    pub fn scan(&mut self, now: i64) {
        self.waiting |= self.button;
        self.t.on(true, 20_000_000, now);
        let is_over = self.t.q;
        match self.phase {
            Phase::Red if is_over => {
                self.phase = Phase::RedAmber;
                self.t.on(false, 20_000_000, now);
                self.walk = false;
            }
            Phase::RedAmber if is_over => {
                self.phase = Phase::Green;
                self.t.on(false, 20_000_000, now);
                self.greens += 1;
            }
            Phase::Green if is_over && self.waiting => {
                self.phase = Phase::Amber;
                self.t.on(false, 20_000_000, now);
            }
            Phase::Amber if is_over => {
                self.phase = Phase::Red;
                self.t.on(false, 20_000_000, now);
                (self.waiting, self.walk) = (false, true);
            }
            _ => {}
        }
    }
}
