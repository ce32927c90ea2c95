//! The programs on a machine without an operating system, which reports what it finds by the calls that QEMU's user mode takes.
#![no_std]
#![no_main]

mod drive;
mod entries;

#[cfg(target_arch = "arm")]
core::arch::global_asm!(".thumb", ".global _start", ".thumb_func", "_start:", "bl begin", "0: b 0b");
#[cfg(target_arch = "riscv32")]
core::arch::global_asm!(".global _start", "_start:", "call begin", "0: j 0b");

const WRITE: usize = if cfg!(target_arch = "arm") { 4 } else { 64 };
const EXIT: usize = if cfg!(target_arch = "arm") { 1 } else { 93 };

fn system(number: usize, a: usize, b: usize, c: usize) {
    // SAFETY: it writes a text, or ends the program.
    #[cfg(target_arch = "arm")]
    unsafe {
        core::arch::asm!("push {{r7}}", "mov r7, {n}", "svc 0", "pop {{r7}}", n = in(reg) number, inlateout("r0") a => _, in("r1") b, in("r2") c);
    }
    // SAFETY: as above.
    #[cfg(target_arch = "riscv32")]
    unsafe {
        core::arch::asm!("ecall", in("a7") number, inlateout("a0") a => _, in("a1") b, in("a2") c);
    }
}

struct Output;

impl core::fmt::Write for Output {
    fn write_str(&mut self, text: &str) -> core::fmt::Result {
        system(WRITE, 1, text.as_ptr() as usize, text.len());
        Ok(())
    }
}

#[unsafe(no_mangle)]
extern "C" fn begin() -> ! {
    let wrong = drive::all(entries::ENTRIES, &mut Output);
    system(EXIT, wrong.min(1), 0, 0);
    loop {}
}

#[panic_handler]
fn panic(info: &core::panic::PanicInfo<'_>) -> ! {
    let _ = core::fmt::Write::write_fmt(&mut Output, format_args!("{info}\n"));
    system(EXIT, 2, 0, 0);
    loop {}
}
