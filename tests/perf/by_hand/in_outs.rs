#[derive(Clone, Copy)]
struct Axis {
    position: i32,
    speed: i32,
    target: i32,
    moving: bool,
    history: [i32; 16],
    pos: u16,
}

impl Axis {
    const NEW: Self = Self { position: 0, speed: 0, target: 0, moving: false, history: [0; 16], pos: 0 };

    fn move_to(&mut self, target: i32) {
        self.target = target;
        self.moving = self.position != target;
        self.speed = target.wrapping_sub(self.position).clamp(-5, 5);
        self.position = self.position.wrapping_add(self.speed);
        self.history[usize::from(self.pos % 16)] = self.position;
        self.pos = (self.pos + 1) % 16;
    }
}

pub struct Program {
    pub x: i32,
    axes: [Axis; 4],
    pub out: i32,
}

impl Program {
    pub const NEW: Self = Self { x: 0, axes: [Axis::NEW; 4], out: 0 };

    pub fn scan(&mut self, _: i64) {
        self.axes[0].move_to(self.x);
        self.axes[1].move_to(self.x.wrapping_mul(2));
        self.axes[2].move_to(self.axes[0].position);
        self.axes[3].move_to(self.axes[1].position.wrapping_sub(self.x));
        self.out = self.axes[2].position.wrapping_add(self.axes[3].position);
    }
}
