/*
 * Edges are made by the timers' compare units, never by a program: software only says, well before, at which tick the
 * next one is due. So no interrupt and no USB request can move an edge, as long as each is announced in time.
 *
 *            period                       a comparator sees 16 bits, and a wait may be longer:
 *     |<------------------>|              so it goes in hops at whose end the pin is left alone
 *   __/~~~~~~\_____________/~~~~~~\____
 *     ^ edge ^      ^      ^              edge: the comparator is connected, and toggles its pin
 *                  hop                    hop:  disconnected, the port holds the level
 *
 * Timer 1 makes both cameras' edges, with two comparators at the same value: they leave in the same cycle. Timer 3
 * counts in step with it and makes the light's. Both count cycles of the crystal: 1 tick = 62.5 ns.
 */
#include "pulses.h"

#include <avr/interrupt.h>
#include <avr/io.h>
#include <util/atomic.h>

#define CAMERA_PINS (_BV(PB5) | _BV(PB6))
#define LIGHT_PIN _BV(PC6)
#define START_PIN _BV(PD4)

/* A wait up to LONGEST is one leg; a longer one goes in hops, which leave at least LONGEST - HOP for the last. Below
 * 2^15, so that "already" and "not yet" can be told apart in 16 bits. */
#define LONGEST 0x7000
#define HOP 0x4000

/* What one timer's outputs do. */
struct wave {
	uint32_t leg_end;   /* tick at which the comparator matches */
	uint32_t remaining; /* ticks from there to the next edge; 0: there is the edge */
	uint32_t on;        /* ticks that a pulse lasts */
	uint32_t fraction;  /* of the period, carried over, in 2^-32 ticks */
	uint32_t left;      /* pulses still to begin */
	bool active;
};

#define QUEUE_LENGTH 16 /* a power of two */

static struct pong_trigger_settings settings;
static struct wave cameras, light;
static volatile uint8_t state;
static uint32_t pulses, unreported;
static struct pong_trigger_pulse queue[QUEUE_LENGTH];
static uint8_t queue_head, queue_tail; /* count on; the place is their remainder */
static uint16_t wraps;                 /* of timer 1: the upper half of the tick */
static uint32_t heard;                 /* tick of the last sign of life of the host */

/* With interrupts off. */
static uint32_t tick_now(void)
{
	uint16_t high = wraps;
	const uint16_t low = TCNT1;

	if ((TIFR1 & _BV(TOV1)) && low < 0x8000)
		high++;
	return (uint32_t)high << 16 | low;
}

static uint8_t camera_level(bool active)
{
	return active != (settings.active_low != 0) ? CAMERA_PINS : 0;
}

/* The comparator has matched at wave->leg_end: says what comes next. Returns true where that was an edge. */
static inline bool wave_step(struct wave *wave)
{
	const bool edge = wave->remaining == 0;
	uint32_t leg;

	if (edge) {
		wave->active = !wave->active;
		if (wave->active) {
			wave->remaining = wave->on;
			if (settings.count)
				wave->left--;
		} else {
			const uint32_t before = wave->fraction;

			wave->fraction += settings.period_fraction;
			wave->remaining = settings.period_ticks - wave->on + (wave->fraction < before);
		}
	}
	leg = wave->remaining <= LONGEST ? wave->remaining : HOP;
	wave->remaining -= leg;
	wave->leg_end += leg;
	return edge;
}

/* Whether the last pulse has ended. */
static inline bool wave_done(const struct wave *wave)
{
	return !wave->active && !wave->left;
}

/* A match that was pending since before the start is none of ours. */
static inline bool wave_reached(const struct wave *wave, uint16_t now)
{
	return (int16_t)(now - (uint16_t)wave->leg_end) >= 0;
}

static void wave_begin(struct wave *wave, uint32_t tick, uint32_t on)
{
	*wave = (struct wave){.leg_end = tick, .on = on, .left = settings.count ? settings.count : 1};
}

static inline void report(uint32_t tick)
{
	pulses++;
	if ((uint8_t)(queue_head - queue_tail) == QUEUE_LENGTH)
		unreported++;
	else
		queue[queue_head++ % QUEUE_LENGTH] = (struct pong_trigger_pulse){pulses, tick};
}

static inline void rest_when_done(void)
{
	if (wave_done(&cameras) && (!settings.light_ticks || wave_done(&light)))
		state = PONG_TRIGGER_RESTING;
}

/* The port is given the level that the comparator's latch has before the pin changes hands: no glitch. */
ISR(TIMER1_COMPA_vect)
{
	const uint32_t tick = cameras.leg_end;

	if (!wave_reached(&cameras, TCNT1))
		return;
	if (wave_step(&cameras)) {
		PORTB = camera_level(cameras.active);
		if (cameras.active)
			report(tick);
	}
	OCR1A = (uint16_t)cameras.leg_end;
	OCR1B = (uint16_t)cameras.leg_end;
	if (wave_done(&cameras)) {
		TCCR1A = 0;
		TIMSK1 &= ~_BV(OCIE1A);
		rest_when_done();
	} else {
		TCCR1A = cameras.remaining ? 0 : _BV(COM1A0) | _BV(COM1B0);
	}
}

ISR(TIMER3_COMPA_vect)
{
	if (!wave_reached(&light, TCNT3))
		return;
	if (wave_step(&light))
		PORTC = light.active ? LIGHT_PIN : 0;
	OCR3A = (uint16_t)light.leg_end;
	if (wave_done(&light)) {
		TCCR3A = 0;
		TIMSK3 &= ~_BV(OCIE3A);
		rest_when_done();
	} else {
		TCCR3A = light.remaining ? 0 : _BV(COM3A0);
	}
}

ISR(TIMER1_OVF_vect)
{
	wraps++;
}

/* With interrupts off, and the outputs at rest. */
static void begin(uint32_t tick)
{
	wave_begin(&cameras, tick, settings.width_ticks);
	OCR1A = (uint16_t)tick;
	OCR1B = (uint16_t)tick;
	TCCR1A = _BV(COM1A0) | _BV(COM1B0);
	TIMSK1 |= _BV(OCIE1A);
	if (settings.light_ticks) {
		wave_begin(&light, tick, settings.light_ticks);
		OCR3A = (uint16_t)tick;
		TCCR3A = _BV(COM3A0);
		TIMSK3 = _BV(OCIE3A);
	}
	state = PONG_TRIGGER_RUNNING;
}

/* The timer latched when the start input fell. */
ISR(TIMER1_CAPT_vect)
{
	const uint32_t now = tick_now();
	const uint16_t ago = (uint16_t)now - ICR1;

	TIMSK1 &= ~_BV(ICIE1);
	if (state == PONG_TRIGGER_ARMED)
		begin(now - ago + PONG_TRIGGER_LEAD);
}

/* Forces the comparators' latches to the inactive level while they still have the pins, then gives the pins to the
 * ports: a pin that was active changes once, a pin that was not does not change. With interrupts off. */
static void rest(void)
{
	const uint8_t level = camera_level(false);

	TIMSK1 = _BV(TOIE1);
	TIMSK3 = 0;
	TCCR1A = level ? _BV(COM1A1) | _BV(COM1A0) | _BV(COM1B1) | _BV(COM1B0) : _BV(COM1A1) | _BV(COM1B1);
	TCCR1C = _BV(FOC1A) | _BV(FOC1B);
	PORTB = level;
	TCCR1A = 0;
	TCCR3A = _BV(COM3A1);
	TCCR3C = _BV(FOC3A);
	PORTC = 0;
	TCCR3A = 0;
	state = PONG_TRIGGER_RESTING;
}

/* Both timers' counters are written 4 cycles apart (each takes two stores of two cycles), and timer 3's is 4 ahead. */
static void timers_in_step(void)
{
	TCCR1B = _BV(ICNC1) | _BV(CS10); /* capture a fall, with the noise canceller's 4 cycles */
	TCCR3B = _BV(CS30);
	__asm__ volatile("sts %[t1]+1, __zero_reg__\n\t"
			 "sts %[t1], __zero_reg__\n\t"
			 "sts %[t3]+1, __zero_reg__\n\t"
			 "sts %[t3], %[four]\n\t"
			 :
			 : [t1] "n"(_SFR_MEM_ADDR(TCNT1)), [t3] "n"(_SFR_MEM_ADDR(TCNT3)), [four] "r"((uint8_t)4));
}

void pulses_init(void)
{
	PORTD = START_PIN;
	timers_in_step();
	rest();
	DDRB = CAMERA_PINS;
	DDRC = LIGHT_PIN;
}

static bool width_fits(uint32_t width, uint32_t period)
{
	return width >= PONG_TRIGGER_MIN_TICKS && width <= period - PONG_TRIGGER_MIN_TICKS;
}

bool pulses_set(const struct pong_trigger_settings *wanted)
{
	if (state != PONG_TRIGGER_RESTING || wanted->period_ticks < PONG_TRIGGER_MIN_PERIOD ||
	    wanted->period_ticks > PONG_TRIGGER_MAX_PERIOD || !width_fits(wanted->width_ticks, wanted->period_ticks) ||
	    (wanted->light_ticks && !width_fits(wanted->light_ticks, wanted->period_ticks)) || wanted->active_low > 1)
		return false;
	ATOMIC_BLOCK(ATOMIC_RESTORESTATE)
	{
		settings = *wanted;
		rest();
	}
	return true;
}

bool pulses_start(uint8_t how)
{
	if (state != PONG_TRIGGER_RESTING || !settings.period_ticks || how > PONG_TRIGGER_START_ON_EDGE)
		return false;
	ATOMIC_BLOCK(ATOMIC_RESTORESTATE)
	{
		pulses = unreported = 0;
		queue_tail = queue_head;
		heard = tick_now();
		if (how == PONG_TRIGGER_START_NOW) {
			begin(heard + PONG_TRIGGER_LEAD);
		} else {
			state = PONG_TRIGGER_ARMED;
			TIFR1 = _BV(ICF1);
			TIMSK1 |= _BV(ICIE1);
		}
	}
	return true;
}

void pulses_stop(void)
{
	ATOMIC_BLOCK(ATOMIC_RESTORESTATE)
	{
		rest();
	}
}

void pulses_status(struct pong_trigger_status *status)
{
	ATOMIC_BLOCK(ATOMIC_RESTORESTATE)
	{
		heard = tick_now();
		*status = (struct pong_trigger_status){state, heard, pulses, unreported};
	}
}

void pulses_guard(void)
{
	uint32_t silence = 0;

	if (state == PONG_TRIGGER_RESTING)
		return;
	ATOMIC_BLOCK(ATOMIC_RESTORESTATE)
	{
		silence = tick_now() - heard;
	}
	if (silence > PONG_TRIGGER_SILENCE)
		pulses_stop();
}

bool pulses_report(struct pong_trigger_pulse *pulse)
{
	bool any = false;

	ATOMIC_BLOCK(ATOMIC_RESTORESTATE)
	{
		if (queue_tail != queue_head) {
			*pulse = queue[queue_tail++ % QUEUE_LENGTH];
			any = true;
		}
	}
	return any;
}
