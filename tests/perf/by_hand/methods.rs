#[derive(Clone, Copy)]
struct Drive {
    speed: i16,
    limit: i16,
    on: bool,
    starts: i32,
}

impl Drive {
    const NEW: Self = Self { speed: 50, limit: 50, on: false, starts: 0 };

    fn start(&mut self) -> bool {
        if !self.on {
            self.on = true;
            self.starts += 1;
        }
        self.on
    }

    fn halt(&mut self) {
        self.on = false;
        self.speed = 0;
    }

    fn set_speed(&mut self, speed: i16) {
        self.speed = speed.max(0).min(self.limit);
    }
}

pub struct Program {
    pub go: bool,
    pub speed: i16,
    a: Drive,
    b: Drive,
    c: Drive,
    pub total: i32,
}

impl Program {
    pub const NEW: Self = Self { go: false, speed: 0, a: Drive::NEW, b: Drive::NEW, c: Drive::NEW, total: 0 };

    pub fn scan(&mut self, _: i64) {
        if self.go {
            self.a.start();
            self.b.start();
            self.c.start();
            self.a.set_speed(self.speed);
            self.b.set_speed(self.speed / 2);
            self.c.set_speed(self.a.speed.wrapping_add(self.b.speed));
        } else {
            self.a.halt();
            self.b.halt();
            self.c.halt();
        }
        let speeds = [self.a.speed, self.b.speed, self.c.speed];
        self.total = speeds.into_iter().fold(self.total, |sum, it| sum.wrapping_add(i32::from(it)));
    }
}
