#include "app/stop_signals.hpp"

#include <array>
#include <csignal>

namespace greenwater {
namespace {

constexpr std::array stop_signals{SIGINT, SIGTERM, SIGHUP};

volatile std::sig_atomic_t last_signal = 0;

void remember(int signal) {
  last_signal = signal;
  for (const int each : stop_signals) std::signal(each, SIG_DFL);  // the next one kills, whichever it is
}

void listen(int signal) {
  struct sigaction before {};
  sigaction(signal, nullptr, &before);
  if (before.sa_handler == SIG_IGN) return;  // nohup, or a shell's background job
  struct sigaction action {};
  action.sa_handler = remember;
  action.sa_flags = SA_RESTART;
  sigaction(signal, &action, nullptr);
}

}  // namespace

StopSignals::StopSignals() {
  last_signal = 0;
  for (const int signal : stop_signals) listen(signal);
  for (const int signal : {SIGPIPE, SIGXFSZ}) std::signal(signal, SIG_IGN);  // the write itself fails, and says why
}

StopSignals::~StopSignals() {
  for (const int signal : stop_signals) {
    struct sigaction now {};
    sigaction(signal, nullptr, &now);
    if (now.sa_handler == remember) std::signal(signal, SIG_DFL);
  }
}

int StopSignals::received() const { return last_signal; }

}  // namespace greenwater
