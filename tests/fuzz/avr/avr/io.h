/* The registers of the ATmega32U4's USB that the firmware touches, on a host: those that a bus changes ask the fuzzer
 * what they hold. */
#pragma once

#include <stdint.h>

#define _BV(bit) (1 << (bit))

uint8_t *bus_flags(void); /* UEINTX */
uint8_t *bus_reset(void); /* UDINT */
uint8_t *bus_data(void);  /* UEDATX */
uint8_t *bus_count(void); /* UEBCLX */

#define UEINTX (*bus_flags())
#define UDINT (*bus_reset())
#define UEDATX (*bus_data())
#define UEBCLX (*bus_count())

/* Those that only take what is written. */
extern uint8_t USBCON, UHWCON, PLLFRQ, PLLCSR, UDCON, UENUM, UECONX, UECFG0X, UECFG1X, UERST, UDADDR;

enum { TXINI = 0, RXOUTI = 2, RXSTPI = 3, FIFOCON = 7 }; /* UEINTX */
enum { EORSTI = 3 };                                     /* UDINT */
enum { EPEN = 0, RSTDT = 3, STALLRQ = 5 };               /* UECONX */
enum { EPDIR = 0, EPTYPE0 = 6, EPTYPE1 = 7 };            /* UECFG0X */
enum { ALLOC = 1, EPBK0 = 2, EPSIZE0 = 4, EPSIZE1 = 5 }; /* UECFG1X */
enum { ADDEN = 7, FRZCLK = 5, USBE = 7, OTGPADE = 4, UVREGE = 0, PDIV2 = 2, PINDIV = 4, PLLE = 1, PLOCK = 0 };
