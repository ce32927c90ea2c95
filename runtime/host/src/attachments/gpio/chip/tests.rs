//! The structures and numbers are those of the kernel's header, as a C compiler has them.

use super::abi::{Attribute, ChipInfo, Config, ConfigAttribute, LineInfo, Request, Values};
use super::*;
use crate::attachments::gpio::group::Place;
use std::mem::offset_of;
use std::process::Command;
use std::time::Duration;

const HEADER: &str = r#"
#include <linux/gpio.h>
#include <stddef.h>
#include <stdio.h>
#define SIZE(of) printf("%zu\n", sizeof(struct of))
#define AT(of, member) printf("%zu\n", offsetof(struct of, member))
int main(void) {
    printf("%lx %lx %lx %lx %lx\n", (unsigned long)GPIO_GET_CHIPINFO_IOCTL, (unsigned long)GPIO_V2_GET_LINEINFO_IOCTL,
           (unsigned long)GPIO_V2_GET_LINE_IOCTL, (unsigned long)GPIO_V2_LINE_GET_VALUES_IOCTL, (unsigned long)GPIO_V2_LINE_SET_VALUES_IOCTL);
    printf("%llx %llx %llx %llx %llx %llx %llx %d %d\n", (unsigned long long)GPIO_V2_LINE_FLAG_USED, (unsigned long long)GPIO_V2_LINE_FLAG_ACTIVE_LOW,
           (unsigned long long)GPIO_V2_LINE_FLAG_INPUT, (unsigned long long)GPIO_V2_LINE_FLAG_OUTPUT,
           (unsigned long long)GPIO_V2_LINE_FLAG_BIAS_PULL_UP, (unsigned long long)GPIO_V2_LINE_FLAG_BIAS_PULL_DOWN,
           (unsigned long long)GPIO_V2_LINE_FLAG_BIAS_DISABLED, GPIO_V2_LINE_ATTR_ID_OUTPUT_VALUES, GPIO_V2_LINE_ATTR_ID_DEBOUNCE);
    SIZE(gpiochip_info); AT(gpiochip_info, lines);
    SIZE(gpio_v2_line_attribute); AT(gpio_v2_line_attribute, values); AT(gpio_v2_line_attribute, debounce_period_us);
    SIZE(gpio_v2_line_config_attribute); AT(gpio_v2_line_config_attribute, mask);
    SIZE(gpio_v2_line_config); AT(gpio_v2_line_config, num_attrs); AT(gpio_v2_line_config, attrs);
    SIZE(gpio_v2_line_request); AT(gpio_v2_line_request, consumer); AT(gpio_v2_line_request, config);
    AT(gpio_v2_line_request, num_lines); AT(gpio_v2_line_request, event_buffer_size); AT(gpio_v2_line_request, fd);
    SIZE(gpio_v2_line_info); AT(gpio_v2_line_info, consumer); AT(gpio_v2_line_info, offset); AT(gpio_v2_line_info, flags);
    SIZE(gpio_v2_line_values); AT(gpio_v2_line_values, mask);
    return 0;
}
"#;

#[test]
fn structures_are_those_of_the_header() {
    let folder = std::env::temp_dir().join(format!("staunch-gpio-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("gpio.c"), HEADER).unwrap();
    let program = folder.join("gpio");
    let compiled = Command::new("cc").arg(folder.join("gpio.c")).arg("-o").arg(&program).output();
    let is_compiled = compiled.is_ok_and(|it| it.status.success());
    let output = is_compiled.then(|| Command::new(&program).output().unwrap().stdout);
    std::fs::remove_dir_all(&folder).unwrap();
    let Some(output) = output else {
        assert!(std::env::var_os("CI").is_none(), "apt-get install gcc linux-libc-dev");
        return;
    };
    let calls =
        [abi::CHIP_INFO, abi::LINE_INFO, abi::REQUEST, abi::GET_VALUES, abi::SET_VALUES].map(|it| format!("{it:x}"));
    let flags = [abi::USED, abi::ACTIVE_LOW, abi::INPUT, abi::OUTPUT, abi::PULL_UP, abi::PULL_DOWN, abi::NO_BIAS];
    let flags = flags.map(|it| format!("{it:x}")).join(" ");
    let layout = [
        size_of::<ChipInfo>(),
        offset_of!(ChipInfo, lines),
        size_of::<Attribute>(),
        offset_of!(Attribute, value),
        offset_of!(Attribute, value),
        size_of::<ConfigAttribute>(),
        offset_of!(ConfigAttribute, mask),
        size_of::<Config>(),
        offset_of!(Config, attributes),
        offset_of!(Config, all),
        size_of::<Request>(),
        offset_of!(Request, consumer),
        offset_of!(Request, config),
        offset_of!(Request, lines),
        offset_of!(Request, buffer),
        offset_of!(Request, descriptor),
        size_of::<LineInfo>(),
        offset_of!(LineInfo, consumer),
        offset_of!(LineInfo, offset),
        offset_of!(LineInfo, flags),
        size_of::<Values>(),
        offset_of!(Values, mask),
    ];
    let layout = layout.map(|it| it.to_string()).join("\n");
    let attributes = format!("{} {}", abi::OUTPUT_VALUES, abi::DEBOUNCE);
    let expected = format!("{}\n{flags} {attributes}\n{layout}\n", calls.join(" "));
    assert_eq!(String::from_utf8(output).unwrap(), expected);
}

fn group(is_output: bool) -> Group {
    let place = |number, initial| Place { line: PinLine::Number(number), point: 0, initial };
    let lines = vec![place(17, false), place(4, true)];
    let (chip, debounce) = ("gpiochip0".to_owned(), (!is_output).then_some(Duration::from_millis(5)));
    Group { chip, is_output, active_low: !is_output, bias: Bias::PullUp, debounce, lines }
}

#[test]
fn a_request_has_the_settings() {
    let inputs = request(&group(false), &[17, 4]);
    assert_eq!((inputs.lines, &inputs.offsets[..3], &inputs.consumer[..8]), (2, &[17, 4, 0][..], &b"staunch\0"[..]));
    assert_eq!(inputs.config.flags, abi::INPUT | abi::ACTIVE_LOW | abi::PULL_UP);
    let debounce = inputs.config.all[0];
    assert_eq!((inputs.config.attributes, debounce.attribute.id, debounce.mask), (1, abi::DEBOUNCE, 3));
    assert_eq!(debounce.attribute.value, [5000, 0]);
    let outputs = request(&group(true), &[17, 4]);
    assert_eq!(outputs.config.flags, abi::OUTPUT | abi::PULL_UP);
    let initial = outputs.config.all[0];
    assert_eq!((outputs.config.attributes, initial.attribute.id, initial.mask), (1, abi::OUTPUT_VALUES, 3));
    assert_eq!(initial.attribute.value, if cfg!(target_endian = "big") { [0, 2] } else { [2, 0] });
}

/// Real files, and what the kernel says of them.
#[test]
fn what_cannot_be_opened_is_explained() {
    let open = |chip: &str| Kernel.open(&Group { chip: chip.to_owned(), ..group(false) }).err().unwrap();
    assert!(open("gpiochip77").starts_with("no such chip: "), "{}", open("gpiochip77"));
    assert_eq!(open("/dev/null"), "it is not a GPIO chip");
    let refused = not_opened(&ErrorKind::PermissionDenied.into());
    assert!(refused.contains("sudo usermod -aG gpio USER"), "{refused}");
    let null = File::open("/dev/null").unwrap();
    for (error, expected) in
        [(16, "is used by another program or a driver"), (22, "the kernel refuses"), (25, "Linux 5.10")]
    {
        let text = not_requested(&null, &[3], &io::Error::from_raw_os_error(error));
        assert!(text.contains(expected), "{text}");
    }
    assert!(offset(&null, 8, &PinLine::Number(8)).unwrap_err().contains("8 lines, from 0 on"));
    assert!(offset(&null, 8, &PinLine::Name("GPIO17".to_owned())).unwrap_err().contains("named \"GPIO17\""));
}
