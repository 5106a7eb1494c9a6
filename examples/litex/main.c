/* Firmware: sends commands through the serializer, reads what the motor reports, and prints it. */

#include <stdio.h>

#include <generated/csr.h>
#include <generated/mem.h>
#include <generated/soc.h>
#ifdef REPORT_INTERRUPT
#include <irq.h>
#endif

#include "geometry_msgs_msg_Twist_cdr_8_deserializer_registers.h"
#include "geometry_msgs_msg_Twist_cdr_8_serializer_registers.h"

static int put(char character, FILE *file)
{
  (void)file;
  while (uart_txfull_read())
    ;
  uart_rxtx_write(character);
  return character;
}

static FILE console = FDEV_SETUP_STREAM(put, NULL, NULL, _FDEV_SETUP_WRITE);
FILE *const stdout = &console;

#define RX(register) (report[GEOMETRY_MSGS_MSG_TWIST_RX_##register / 4])

static volatile uint32_t *const command = (volatile uint32_t *)COMMAND_BASE;
static volatile uint32_t *const report = (volatile uint32_t *)REPORT_BASE;
static volatile unsigned interrupts;

/* Called by LiteX's start-up code. The interrupt is a level: it ends when its event is cleared. */
void isr(void)
{
  RX(INTERRUPT) = GEOMETRY_MSGS_MSG_TWIST_RX_INTERRUPT_MESSAGE_MASK;
  interrupts++;
}

int main(void)
{
  geometry_msgs_msg_Twist_t sent = {0}, read = {0};
  int number;

  if (!geometry_msgs_msg_Twist_tx_is(command) || !geometry_msgs_msg_Twist_rx_is(report))
    printf("other registers\n");
#ifdef REPORT_INTERRUPT
  RX(INTERRUPT_ENABLE) = GEOMETRY_MSGS_MSG_TWIST_RX_INTERRUPT_ENABLE_MESSAGE_MASK;
  report_ev_enable_write(1);
  irq_setmask(1 << REPORT_INTERRUPT);
  irq_setie(1);
#endif
  for (number = 1; number <= 3; number++) {
    sent.linear.x = 0.5 * number;
    sent.angular.z = -0.25 * number;
    sent.linear.y = 9;
    while (!geometry_msgs_msg_Twist_tx_send(command, &sent))
      ;
    while (!geometry_msgs_msg_Twist_rx_receive(report, &read))
      ;
    printf("linear.x %.3f, linear.y %.3f, angular.z %.3f\n",
      read.linear.x, read.linear.y, read.angular.z);
  }
  printf("the motor got %u messages, %u errors; %u interrupts\n",
    (unsigned)motor_messages_read(), (unsigned)motor_errors_read(), interrupts);
  while (!uart_txempty_read())
    ;
  main_finish_write(1);
  return 0;
}
