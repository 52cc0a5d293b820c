# pongeye-trigger, its firmware and their tests; included by the top Makefile.
#   make firmware        build/firmware/pongeye-trigger.hex, for the ATmega32U4
#   make flash           write it (press the board's reset first); PORT=/dev/ttyACM0
#   make test-trigger    the firmware in simavr, and pongeye-trigger against it
#   make test-hil        pongeye-trigger in a virtual machine, with Debian's kernel, GPIO lines and USB

TRIGGER_DEBIAN_PACKAGES := gcc-avr avr-libc libsimavr-dev libelf-dev libgtest-dev

# --- The firmware

AVR_CFLAGS := -mmcu=atmega32u4 -DF_CPU=16000000UL -std=c11 -O2 -g -Wall -Wextra -Wshadow -Werror -ffunction-sections
FIRMWARE   := $(BUILD)/firmware/pongeye-trigger
FIRMWARE_SOURCES := $(wildcard trigger/firmware/*.c)

.PHONY: firmware flash
firmware: $(FIRMWARE).hex

$(FIRMWARE).elf: $(FIRMWARE_SOURCES) $(wildcard trigger/firmware/*.h) trigger/protocol.h
	@mkdir -p $(@D)
	avr-gcc $(AVR_CFLAGS) -Wl,--gc-sections $(FIRMWARE_SOURCES) -o $@
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

TRIGGER_TESTS := $(BUILD)/tests/trigger/test_firmware

$(BUILD)/obj/tests/trigger/%.o: tests/trigger/%.cpp
	@mkdir -p $(@D)
	$(CXX) $(CPPFLAGS) $(CXXFLAGS) -I. -c $< -o $@

$(BUILD)/tests/trigger/test_firmware: $(BUILD)/obj/tests/trigger/test_firmware.o $(BUILD)/obj/tests/trigger/board.o
	@mkdir -p $(@D)
	$(CXX) $(LDFLAGS) $^ -lsimavr -lelf -lgtest -pthread -o $@

.PHONY: test-trigger
test-trigger:
	@$(MAKE) --no-print-directory deps DEBIAN_PACKAGES="$(TRIGGER_DEBIAN_PACKAGES)"
	@$(MAKE) --no-print-directory $(FIRMWARE).hex $(TRIGGER_TESTS)
	$(BUILD)/tests/trigger/test_firmware $(FIRMWARE).elf
