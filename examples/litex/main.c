/* Firmware: sends commands through the serializer, reads what the motor reports, and prints it. */

#include <stdio.h>

#include <generated/csr.h>
#include <generated/mem.h>

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

/* Called by LiteX's start-up code; the registers are polled here. */
void isr(void)
{
}

int main(void)
{
  volatile uint32_t *command = (volatile uint32_t *)COMMAND_BASE;
  volatile uint32_t *report = (volatile uint32_t *)REPORT_BASE;
  geometry_msgs_msg_Twist_t sent = {0}, read = {0};
  int number;

  if (!geometry_msgs_msg_Twist_tx_is(command) || !geometry_msgs_msg_Twist_rx_is(report))
    printf("other registers\n");
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
  printf("the motor got %u messages, %u errors\n",
    (unsigned)motor_messages_read(), (unsigned)motor_errors_read());
  while (!uart_txempty_read())
    ;
  main_finish_write(1);
  return 0;
}
