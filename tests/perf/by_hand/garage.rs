use crate::blocks::Ctud;

pub struct Program {
    pub car_in: bool,
    pub car_out: bool,
    pub clear: bool,
    pub full: bool,
    pub empty: bool,
    pub count: i16,
    cars: Ctud,
}

impl Program {
    pub const NEW: Self =
        Self { car_in: false, car_out: false, clear: false, full: false, empty: false, count: 0, cars: Ctud::NEW };

    pub fn scan(&mut self, _: i64) {
        self.cars.call(self.car_in, self.car_out, self.clear, false, 200);
        self.full = self.cars.qu;
        self.empty = self.cars.qd;
        self.count = self.cars.cv;
    }
}
