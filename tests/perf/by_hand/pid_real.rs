#[derive(Clone, Copy)]
struct Pid {
    sp: f32,
    pv: f32,
    kp: f32,
    ki: f32,
    kd: f32,
    dt: f32,
    low: f32,
    high: f32,
    manual: bool,
    manual_value: f32,
    out: f32,
    saturated: bool,
    integral: f32,
    last_error: f32,
    error: f32,
    derivative: f32,
    unlimited: f32,
}

impl Pid {
    const NEW: Self = Self {
        sp: 0.0,
        pv: 0.0,
        kp: 0.0,
        ki: 0.0,
        kd: 0.0,
        dt: 0.0,
        low: 0.0,
        high: 0.0,
        manual: false,
        manual_value: 0.0,
        out: 0.0,
        saturated: false,
        integral: 0.0,
        last_error: 0.0,
        error: 0.0,
        derivative: 0.0,
        unlimited: 0.0,
    };

    #[inline]
    fn call(&mut self) {
        self.error = self.sp - self.pv;
        if self.manual {
            self.out = self.manual_value;
            self.integral = self.manual_value - self.kp * self.error;
            self.saturated = false;
        } else {
            self.derivative = (self.error - self.last_error) / self.dt;
            self.unlimited = self.kp * self.error + self.integral + self.kd * self.derivative;
            self.saturated = false;
            if self.unlimited > self.high {
                self.unlimited = self.high;
                self.saturated = true;
            } else if self.unlimited < self.low {
                self.unlimited = self.low;
                self.saturated = true;
            } else {
                self.integral += self.ki * self.error * self.dt;
            }
            self.out = self.unlimited;
        }
        self.last_error = self.error;
    }
}

pub struct Program {
    pub man: bool,
    pub noise: f32,
    sp: [f32; 16],
    pv: [f32; 16],
    kp: [f32; 16],
    out: [f32; 16],
    pub o1: f32,
    pub o16: f32,
    started: bool,
    channels: [Pid; 16],
}

impl Program {
    pub const NEW: Self = Self {
        man: false,
        noise: 0.0,
        sp: [0.0; 16],
        pv: [0.0; 16],
        kp: [0.0; 16],
        out: [0.0; 16],
        o1: 0.0,
        o16: 0.0,
        started: false,
        channels: [Pid::NEW; 16],
    };

    pub fn scan(&mut self, _: i64) {
        if !self.started {
            self.started = true;
            for i in 0..16 {
                self.kp[i] = 0.5 + (i + 1) as f32 * 0.05;
            }
        }
        for i in 0..16 {
            self.sp[i] = 50.0 + (i + 1) as f32 + self.noise;
        }
        for i in 0..16 {
            let channel = &mut self.channels[i];
            (channel.sp, channel.pv, channel.kp) = (self.sp[i], self.pv[i], self.kp[i]);
            (channel.ki, channel.kd, channel.dt) = (0.2, 0.01, 0.1);
            (channel.low, channel.high) = (-100.0, 100.0);
            (channel.manual, channel.manual_value) = (self.man, 10.0);
            channel.call();
            self.out[i] = channel.out;
        }
        for i in 0..16 {
            self.pv[i] += (self.out[i] - self.pv[i] * 0.3) * 0.05;
        }
        (self.o1, self.o16) = (self.out[0], self.out[15]);
    }
}
