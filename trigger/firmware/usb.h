/* The USB side: enumeration, our requests, and the endpoint that reports pulses. Polled: it owns no interrupt. */
#pragma once

void usb_init(void);

/* Serves what has come; returns at once where nothing has. */
void usb_poll(void);
