# pongeye-trigger, its firmware and their tests; included by the top Makefile.
#   make firmware        build/firmware/pongeye-trigger.hex, for the ATmega32U4
#   make flash           write it (press the board's reset first); PORT=/dev/ttyACM0
#   make test-trigger    the firmware in simavr, pongeye-trigger against it, and the tracker triggered by both
#   make test-hil        pongeye-trigger in a virtual machine, with Debian's kernel, GPIO lines and USB

TRIGGER_DEBIAN_PACKAGES := gcc-avr avr-libc libsimavr-dev libelf-dev libumockdev-dev umockdev libgtest-dev \
	libusb-1.0-0-dev libgpiod-dev liblcm-dev liblcm-bin libeigen3-dev libtomlplusplus-dev libopencv-dev \
	libaravis-dev iproute2 util-linux pkg-config

# --- The program. libgpiod's version decides which of two files speaks to it.

TRIGGER_PACKAGES := libusb-1.0 libgpiod lcm
GPIOD_VERSION = $(if $(filter 1.%,$(shell pkg-config --modversion libgpiod)),1,2)
TRIGGER_SOURCES = $(filter-out trigger/main.cpp trigger/gpio_lines_v%.cpp,$(wildcard trigger/*.cpp))
TRIGGER_OBJECTS = $(TRIGGER_SOURCES:%.cpp=$(BUILD)/obj/%.o) $(BUILD)/obj/trigger/gpio_lines_v$(GPIOD_VERSION).o

DEBIAN_PACKAGES += libusb-1.0-0-dev libgpiod-dev
all: $(BUILD)/bin/pongeye-trigger

.SECONDARY: $(LCM_HPP)
$(BUILD)/obj/trigger/%.o: trigger/%.cpp | $(LCM_HPP)
	$(begin)
	$(Q)$(CXX) $(CPPFLAGS) $(CXXFLAGS) -I$(BUILD)/lcmtypes -Itools/common -Itrigger \
	    $(call cflags,$(TRIGGER_PACKAGES)) -c $< -o $@

# Which objects it needs is asked only now, after libgpiod may have been installed.
.SECONDEXPANSION:
$(BUILD)/bin/pongeye-trigger: $(BUILD)/obj/trigger/main.o $$(TRIGGER_OBJECTS) $(COMMON_OBJECTS)
	$(begin)
	$(Q)$(CXX) $(LDFLAGS) $^ $(call libs,$(TRIGGER_PACKAGES)) -pthread -o $@

# --- The firmware

AVR_CFLAGS := -mmcu=atmega32u4 -DF_CPU=16000000UL -std=c11 -O2 -g -Wall -Wextra -Wshadow -Werror -ffunction-sections
FIRMWARE   := $(BUILD)/firmware/pongeye-trigger
FIRMWARE_SOURCES := $(wildcard trigger/firmware/*.c)

.PHONY: firmware flash
firmware: $(FIRMWARE).hex

$(FIRMWARE).elf: $(FIRMWARE_SOURCES) $(wildcard trigger/firmware/*.h) trigger/protocol.h
	$(begin)
	$(Q)avr-gcc $(AVR_CFLAGS) -Wl,--gc-sections $(FIRMWARE_SOURCES) -o $@
	avr-size $@

$(FIRMWARE).hex: $(FIRMWARE).elf
	avr-objcopy -O ihex -R .eeprom $< $@

# The bootloader of Leonardo, Micro and Pro Micro listens for 8 s after a reset.
PORT ?= /dev/ttyACM0
flash: $(FIRMWARE).hex
	@test -e $(PORT) || { echo "$(PORT) is not there: press the board's reset (on a Pro Micro twice), \
	then make flash within 8 s; or name another port: make flash PORT=..." >&2; false; }
	avrdude -p m32u4 -c avr109 -P $(PORT) -D -U flash:w:$<:i

# --- Tests. They alone link simavr, which is under the GPL.

TRIGGER_TESTS := parts firmware usb pwm
TRIGGER_TEST_PROGRAMS := $(TRIGGER_TESTS:%=$(BUILD)/tests/trigger/test_%)
EMULATED_CLOCK := $(BUILD)/tests/trigger/emulated_clock.so

$(BUILD)/obj/tests/trigger/%.o: tests/trigger/%.cpp | $(LCM_HPP)
	$(begin)
	$(Q)$(CXX) $(CPPFLAGS) $(CXXFLAGS) -I. -I$(BUILD)/lcmtypes -Itools/common $(call cflags,umockdev-1.0 lcm) -c $< -o $@

trigger_test_objects = $(patsubst %,$(BUILD)/obj/tests/trigger/%.o,$(1))
$(BUILD)/tests/trigger/test_firmware: $(call trigger_test_objects,test_firmware test_firmware_usb board)
$(BUILD)/tests/trigger/test_parts: $(BUILD)/obj/tests/trigger/test_parts.o $$(TRIGGER_OBJECTS) $(COMMON_OBJECTS)
	$(begin)
	$(Q)$(CXX) $(LDFLAGS) $^ $(call libs,$(TRIGGER_PACKAGES)) -lgtest -lgtest_main -pthread -o $@

$(BUILD)/tests/trigger/test_pwm: $(call trigger_test_objects,test_pwm child)
$(BUILD)/tests/trigger/test_usb: $(call trigger_test_objects,test_usb board usbfs child)
$(BUILD)/tests/trigger/test_firmware $(BUILD)/tests/trigger/test_usb $(BUILD)/tests/trigger/test_pwm:
	$(begin)
	$(Q)$(CXX) $(LDFLAGS) $^ -lsimavr -lelf $(call libs,umockdev-1.0 lcm) -lgtest -pthread -o $@

$(BUILD)/tests/trigger/live_board: $(call trigger_test_objects,live_board board usbfs child)
	$(begin)
	$(Q)$(CXX) $(LDFLAGS) $^ -lsimavr -lelf $(call libs,umockdev-1.0) -o $@

# What tests/trigger/together.sh runs.
TOGETHER := $(BUILD)/tests/trigger/live_board $(BUILD)/tests/lcm_listener $(BUILD)/bin/pongeye-simulate \
	$(BUILD)/bin/pongeye-track

$(EMULATED_CLOCK): tests/trigger/emulated_clock.c tests/trigger/emulated_clock.h
	$(begin)
	$(Q)$(CC) $(CPPFLAGS) $(CFLAGS) -fvisibility=default -shared $< -o $@

.PHONY: test-trigger
test-trigger:
	@$(MAKE) --no-print-directory deps DEBIAN_PACKAGES="$(TRIGGER_DEBIAN_PACKAGES)"
	@$(MAKE) --no-print-directory $(FIRMWARE).hex $(BUILD)/bin/pongeye-trigger $(TRIGGER_TEST_PROGRAMS) $(EMULATED_CLOCK) \
	    $(TOGETHER)
	@! ldd $(BUILD)/bin/pongeye-trigger | grep simavr
	$(BUILD)/tests/trigger/test_parts
	$(BUILD)/tests/trigger/test_firmware $(FIRMWARE).elf
	umockdev-wrapper $(BUILD)/tests/trigger/test_usb $(FIRMWARE).elf $(BUILD)/bin/pongeye-trigger \
	    $(abspath $(EMULATED_CLOCK))
	umockdev-wrapper $(BUILD)/tests/trigger/test_pwm $(BUILD)/bin/pongeye-trigger
	BUILD=$(BUILD) tests/trigger/together.sh

# --- Emulated hardware: Debian's kernel in QEMU, with gpio-sim for lines and a board in simavr for USB.

HIL := $(BUILD)/hil
HIL_DEBIAN_PACKAGES := $(TRIGGER_DEBIAN_PACKAGES) qemu-system-x86 linux-headers-amd64 busybox-static cpio xz-utils
HIL_PROGRAMS = $(if $(filter 1,$(GPIOD_VERSION)),$(HIL)/pongeye-trigger-gpiod1) $(HIL)/pongeye-trigger-gpiod2

$(HIL)/kernel/vmlinuz: tests/hil/get-kernel
	tests/hil/get-kernel $(HIL)/kernel

$(HIL)/libgpiod2/pkgconfig/libgpiod.pc: tests/hil/get-libgpiod2
	tests/hil/get-libgpiod2 $(HIL)/libgpiod2

$(HIL)/pongeye-trigger-gpiod1: $(BUILD)/bin/pongeye-trigger
	@mkdir -p $(@D)
	cp $< $@

# Where the machine has libgpiod 1, the same sources once more against 2.
$(HIL)/pongeye-trigger-gpiod2: $(BUILD)/bin/pongeye-trigger \
    $$(if $$(filter 1,$$(GPIOD_VERSION)),$(HIL)/libgpiod2/pkgconfig/libgpiod.pc)
	@mkdir -p $(@D)
	$(if $(filter 2,$(GPIOD_VERSION)),cp $< $@,$(call with_libgpiod2,$@))

define with_libgpiod2
	PKG_CONFIG_PATH=$(abspath $(HIL)/libgpiod2/pkgconfig) $(MAKE) --no-print-directory BUILD=$(HIL)/with-libgpiod2 \
	    LDFLAGS="-Wl,-rpath,$$(echo $(abspath $(HIL)/libgpiod2/root/usr/lib)/*-linux-gnu)" \
	    $(HIL)/with-libgpiod2/bin/pongeye-trigger
	cp $(HIL)/with-libgpiod2/bin/pongeye-trigger $(1)
endef

$(BUILD)/obj/tests/hil/%.o: tests/hil/%.cpp
	$(begin)
	$(Q)$(CXX) $(CPPFLAGS) $(CXXFLAGS) -I. -c $< -o $@

$(HIL)/usbip_device: $(BUILD)/obj/tests/hil/usbip_device.o $(BUILD)/obj/tests/trigger/board.o
	$(begin)
	$(Q)$(CXX) $(LDFLAGS) $^ -lsimavr -lelf -o $@

$(HIL)/initrd.gz: $(HIL)/kernel/vmlinuz $(FIRMWARE).elf $$(HIL_PROGRAMS) $(HIL)/usbip_device $(wildcard tests/hil/guest-*) \
    tests/hil/make-initrd
	tests/hil/make-initrd $@ $(HIL)/kernel/modules $(FIRMWARE).elf $(HIL_PROGRAMS) $(HIL)/usbip_device

.PHONY: test-hil
test-hil:
	@$(MAKE) --no-print-directory deps DEBIAN_PACKAGES="$(HIL_DEBIAN_PACKAGES)"
	@$(MAKE) --no-print-directory $(HIL)/initrd.gz
	tests/hil/run $(HIL)/kernel/vmlinuz $(HIL)/initrd.gz
