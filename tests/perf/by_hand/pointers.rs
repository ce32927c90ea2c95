#[derive(Clone, Copy)]
struct Motor {
    speed: i16,
    target: i16,
    running: bool,
    hours: i32,
}

pub struct Program {
    pub pick: i16,
    motors: [Motor; 8],
    pub sum: i32,
}

impl Program {
    pub const NEW: Self =
        Self { pick: 0, motors: [Motor { speed: 0, target: 0, running: false, hours: 0 }; 8], sum: 0 };

    pub fn scan(&mut self, _: i64) {
        self.motors[self.pick as usize].target = 100 + self.pick;
        self.sum = 0;
        for motor in &mut self.motors {
            if motor.speed < motor.target {
                motor.speed += 1;
            } else if motor.speed > motor.target {
                motor.speed -= 1;
            }
            motor.running = motor.speed > 0;
            if motor.running {
                motor.hours += 1;
            }
            self.sum = self.sum.wrapping_add(motor.hours);
        }
    }
}
