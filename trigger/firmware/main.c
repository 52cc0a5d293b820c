/* The firmware of the trigger: ATmega32U4 at 16 MHz (Arduino Leonardo, Micro; Pro Micro), bare metal. */
#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/power.h>
#include <avr/wdt.h>

#include "pulses.h"
#include "usb.h"

int main(void)
{
	MCUSR = 0; /* a bootloader may have left the watchdog running, which survives its reset */
	wdt_disable();
	clock_prescale_set(clock_div_1);
	pulses_init();
	usb_init();
	sei();
	for (;;) {
		usb_poll();
		pulses_guard();
	}
}
