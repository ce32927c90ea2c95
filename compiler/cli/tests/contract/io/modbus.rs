//! A small client, and what the server answers.

use super::{PLANT, Plant, built, has, until};
use crate::Folder;
use std::io::{Read as _, Write as _};
use std::net::TcpStream;
use std::time::Duration;

pub const COILS: u8 = 1;
pub const DISCRETE: u8 = 2;
pub const HOLDING: u8 = 3;
pub const INPUT: u8 = 4;

pub struct Client {
    stream: TcpStream,
    number: u16,
}

impl Client {
    pub fn of(plant: &Plant) -> Self {
        let stream = TcpStream::connect(("127.0.0.1", plant.port)).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(30))).unwrap();
        Self { stream, number: 0x1234 }
    }

    fn frame(&mut self, request: &[u8]) -> Vec<u8> {
        self.number = self.number.wrapping_add(1);
        let [high, low] = self.number.to_be_bytes();
        let mut frame = vec![high, low, 0, 0, 0, request.len() as u8 + 1, 7];
        frame.extend(request);
        frame
    }

    fn receive(&mut self) -> Vec<u8> {
        let mut header = [0; 7];
        self.stream.read_exact(&mut header).unwrap();
        assert_eq!((&header[..2], &header[2..4], header[6]), (&self.number.to_be_bytes()[..], &[0, 0][..], 7));
        let mut answer = vec![0; usize::from(u16::from_be_bytes([header[4], header[5]])) - 1];
        self.stream.read_exact(&mut answer).unwrap();
        answer
    }

    pub fn ask(&mut self, request: &[u8]) -> Vec<u8> {
        let frame = self.frame(request);
        self.stream.write_all(&frame).unwrap();
        self.receive()
    }

    fn bits(&mut self, table: u8, first: u16, count: u16) -> Vec<bool> {
        let answer = self.ask(&[&[table][..], &first.to_be_bytes(), &count.to_be_bytes()].concat());
        assert_eq!(answer[..2], [table, count.div_ceil(8) as u8], "{answer:?}");
        (0..usize::from(count)).map(|at| answer[2 + at / 8] >> (at % 8) & 1 != 0).collect()
    }

    pub fn bit(&mut self, table: u8, at: u16) -> bool {
        self.bits(table, at, 1)[0]
    }

    pub fn words(&mut self, table: u8, first: u16, count: u16) -> Vec<u16> {
        let answer = self.ask(&[&[table][..], &first.to_be_bytes(), &count.to_be_bytes()].concat());
        assert_eq!(answer[..2], [table, 2 * count as u8], "{answer:?}");
        answer[2..].chunks(2).map(|it| u16::from_be_bytes([it[0], it[1]])).collect()
    }

    fn write_words(&mut self, first: u16, values: &[u16]) {
        let [high, low] = first.to_be_bytes();
        let mut request = vec![16, high, low, 0, values.len() as u8, 2 * values.len() as u8];
        request.extend(values.iter().flat_map(|it| it.to_be_bytes()));
        assert_eq!(self.ask(&request), request[..5]);
    }

    /// Whether the server has closed the connection.
    fn is_closed(&mut self) -> bool {
        matches!(self.stream.read(&mut [0]), Ok(0) | Err(_))
    }
}

fn plant(name: &str) -> (Folder, Plant) {
    let folder = built(name, PLANT);
    let plant = Plant::start(&folder, "plant", "--cycle 2ms --io modbus:127.0.0.1:0").listening();
    (folder, plant)
}

#[test]
fn a_program_is_read_and_written_by_modbus() {
    let (_folder, plant) = plant("io_modbus");
    let mut client = Client::of(&plant);
    // %MW4 is number 1024 + 4, %ML1000 is 4096 + 4 * 1000.
    assert_eq!(client.words(HOLDING, 1028, 1), [50]);
    assert_eq!(client.ask(&[5, 0, 0, 0xFF, 0]), [5, 0, 0, 0xFF, 0]);
    until("the output follows", || client.bit(COILS, 9));
    assert!(!client.bit(DISCRETE, 0));
    client.ask(&[6, 4, 4, 0xFF, 0xFF]);
    assert_eq!(client.words(HOLDING, 1028, 1), [0xFFFF]);
    until("a limit of -1 is below", || client.bit(COILS, 16));
    assert_eq!(client.ask(&[15, 0, 0, 0, 10, 2, 0, 0]), [15, 0, 0, 0, 10]);
    until("the output follows again", || !client.bit(COILS, 9));
    let before = client.words(HOLDING, 8096, 4);
    until("scans are counted", || client.words(HOLDING, 8096, 4) > before);
    assert_eq!(before[..2], [0, 0]);
    // Inputs are the program's own.
    assert_eq!(client.words(INPUT, 3, 1), [0]);
    assert_eq!((client.words(INPUT, 0, 125).len(), client.bits(DISCRETE, 6192, 2000).len()), (125, 2000));
    // What no variable has.
    client.write_words(600, &[3, 4]);
    assert_eq!(client.words(HOLDING, 600, 3), [3, 4, 0]);
    assert_eq!(client.ask(&[0x2B, 14, 1, 0]), [0xAB, 1]);
    assert_eq!(client.ask(&[COILS, 0x20, 0, 0, 1]), [0x81, 2]);
    assert_eq!(client.ask(&[INPUT, 4, 0, 0, 1]), [0x84, 2]);
    assert_eq!(client.ask(&[COILS, 0, 0, 0x07, 0xD1]), [0x81, 3]);
    assert_eq!(client.ask(&[HOLDING, 0, 0, 0, 126]), [0x83, 3]);
    assert_eq!(client.ask(&[5, 0, 0, 0, 1]), [0x85, 3]);
    plant.signal("-TERM");
    plant.ended(0);
    assert!(client.is_closed());
}

#[test]
fn clients_see_and_write_whole_scans() {
    let (_folder, plant) = plant("io_whole");
    std::thread::scope(|scope| {
        for number in 0..2_u16 {
            let mut client = Client::of(&plant);
            scope.spawn(move || {
                for turn in 0..300_u16 {
                    let words = client.words(HOLDING, 20, 21);
                    assert_eq!(words[0], words[20]);
                    // %MD500 and %MD520, with 40 registers between them.
                    let value = [turn, turn << 1 | number];
                    let mut values = vec![0; 42];
                    values[..2].copy_from_slice(&value);
                    values[40..].copy_from_slice(&value);
                    client.write_words(3048, &values);
                }
            });
        }
    });
    let mut client = Client::of(&plant);
    let wrote = client.words(HOLDING, 3048, 42);
    assert_eq!((wrote[0], &wrote[..2]), (299, &wrote[40..]));
    let scans = client.words(HOLDING, 8099, 1);
    until("they are in a scan", || client.words(HOLDING, 8099, 1) != scans);
    assert!(!client.bit(COILS, 24), "torn");
}

#[test]
fn bad_clients_harm_nobody() {
    let (_folder, plant) = plant("io_garbage");
    let mut good = Client::of(&plant);
    for garbage in [&b"GET / HTTP/1.1\r\n\r\n"[..], &[0, 1, 0, 0, 0, 1, 7], &[0, 1, 0, 0, 2, 0, 7, 1], &[0xFF; 300]] {
        let mut bad = Client::of(&plant);
        bad.stream.write_all(garbage).unwrap();
        assert!(bad.is_closed(), "{garbage:?}");
        assert_eq!(good.words(HOLDING, 1028, 1), [50]);
    }
    // Half a request, from one that goes away, and from one that stays for a while.
    let mut half = Client::of(&plant);
    let frame = half.frame(&[HOLDING, 0, 0, 0, 1]);
    half.stream.write_all(&frame[..9]).unwrap();
    drop(half);
    let mut slow = Client::of(&plant);
    let frame = slow.frame(&[HOLDING, 4, 4, 0, 1]);
    slow.stream.write_all(&frame[..5]).unwrap();
    assert_eq!(good.words(HOLDING, 1028, 1), [50]);
    std::thread::sleep(Duration::from_millis(50));
    slow.stream.write_all(&frame[5..]).unwrap();
    assert_eq!(slow.receive(), [HOLDING, 2, 0, 50]);
    // Several requests at once are answered one after the other.
    let (first, second) = (good.frame(&[HOLDING, 4, 4, 0, 1]), good.frame(&[HOLDING, 4, 4, 0, 1]));
    good.stream.write_all(&[first, second].concat()).unwrap();
    good.number -= 1;
    good.receive();
    good.number += 1;
    assert_eq!(good.receive(), [HOLDING, 2, 0, 50]);
}

#[test]
fn a_client_too_many_ends_the_one_that_is_idle() {
    let (_folder, plant) = plant("io_clients");
    let mut clients: Vec<Client> = (0..8).map(|_| Client::of(&plant)).collect();
    for client in clients.iter_mut().rev() {
        assert_eq!(client.words(HOLDING, 1028, 1), [50]);
    }
    let mut ninth = Client::of(&plant);
    assert_eq!(ninth.words(HOLDING, 1028, 1), [50]);
    assert!(clients.pop().unwrap().is_closed());
    for client in &mut clients {
        assert_eq!(client.words(HOLDING, 1028, 1), [50]);
    }
}

#[test]
fn every_back_end_has_a_server_and_says_what_has_no_place() {
    let source = "PROGRAM Main VAR b AT %QB3 : BYTE; d AT %QD1 : DWORD; w AT %QW9 : INT := 4; END_VAR w := w + 1; b := 1; d := 2; END_PROGRAM";
    let folder = Folder::with("io_backends", &[("main.st", source)]);
    for backend in ["native", "rust", "interpret"] {
        let io = "--io modbus:127.0.0.1:0 --io-stop hold";
        let command = folder.command(&format!("run main.st --realtime --cycle 5ms --backend {backend} {io}"));
        let plant = Plant::spawn(command).listening();
        let mut client = Client::of(&plant);
        let before = client.words(HOLDING, 9, 1);
        until("it runs", || client.words(HOLDING, 9, 1) > before);
        plant.signal("-INT");
        has(&plant.ended(0), &["note: modbus:127.0.0.1:0 has no place for b (%QB3), d (%QD1)\n"]);
    }
}

#[test]
fn addresses_that_share_bits_are_written_by_any_of_them() {
    let source = "PROGRAM Main VAR word AT %QW0 : WORD; bit AT %QX0.3 : BOOL; high AT %QX1.7 : BOOL; END_VAR
VAR seen AT %QW1 : WORD; END_VAR seen := word; END_PROGRAM";
    let folder = built("io_shared_bits", source);
    let plant = Plant::start(&folder, "plant", "--cycle 2ms --io modbus:127.0.0.1:0").listening();
    let mut client = Client::of(&plant);
    client.ask(&[5, 0, 3, 0xFF, 0]);
    until("the bit is in the word", || client.words(HOLDING, 0, 2) == [8, 8]);
    client.write_words(0, &[0x8001]);
    until("the word has the bits", || client.bits(COILS, 3, 13)[12]);
    assert_eq!((client.bit(COILS, 3), client.words(HOLDING, 0, 2)), (false, vec![0x8001, 0x8001]));
}
