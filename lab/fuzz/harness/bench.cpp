#include "bench.h"

#include <algorithm>

namespace {

// Longer than any stall of the surroundings.
constexpr uint64_t MOST_IDLE = 5000;
// Cycles after all has come, in which nothing may come.
constexpr int QUIET_CYCLES = 24;
// In an episode.
constexpr int MOST_RESETS = 8;
// One packet in so many is cut, at one byte after the other.
constexpr uint64_t CUT_ONE_IN = 8;

}  // namespace

Bench::Bench(Circuit& circuit, const Table& table, uint64_t seed)
    : circuit_(circuit),
      table_(table),
      seed_(seed),
      judge_(table),
      writer_(table),
      damager_(table, seed),
      checker_(make_checker(circuit, table)),
      stalls_(circuit.outputs.size()),
      valid_((circuit.outputs.size() + 31) / 32),
      held_(valid_.size()) {
    for (const Output& output : circuit.outputs) payloads_.emplace_back(output.words);
    *circuit.control = 0;
    circuit.set_clock(true);
    circuit.evaluate();
}

const Bytes* Bench::bytes_of(uint64_t packet) const {
    for (const SentPtr& each : sent_)
        if (each->number == packet) return &each->bytes;
    return nullptr;
}

void Bench::run(uint64_t episode) {
    const uint64_t kind = 2 * static_cast<uint64_t>(circuit_.kind) + circuit_.drops;
    Random random(Random::mixed(seed_, kind, episode));
    start_ = counts.cycles;
    sent_.clear();
    next_ = 0;
    for (uint64_t n = 0; n < EPISODE; ++n) make(random, episode * EPISODE + n);
    const bool may_wait =
        circuit_.kind == CircuitKind::Deserializer && table_.transfers_once();
    stalls_.choose(random, may_wait);
    reset(random, true);
    int resets = random.one_in(4) ? MOST_RESETS : 0;
    const uint32_t apart = 1 + random.below(2000);
    while (!all_sent() || !checker_->is_done()) {
        if (resets && random.one_in(apart)) {
            reset(random, false);
            --resets;
        }
        do_cycle(random);
    }
    for (int n = 0; n < QUIET_CYCLES; ++n) do_cycle(random);
    checker_->at_end();
}

// Make the next packet. Every second one is good, so each bad one is followed by a good one.
void Bench::make(Random& random, uint64_t number) {
    auto packet = std::make_shared<Sent>();
    packet->number = number;
    const bool is_cut = number % CUT_ONE_IN == 1;
    const bool is_whole = number % 2 == 0 || (!is_cut && random.one_in(8));
    if (is_whole) {
        packet->bytes = writer_.write(random).bytes;
    } else {
        Damage kind;
        packet->bytes = is_cut ? damager_.cut(number / CUT_ONE_IN) : damager_.damaged(random, kind);
        if (is_cut) kind = Damage::Cut;
        ++counts.damages[static_cast<size_t>(kind)];
    }
    judge_.judge(packet->bytes, packet->expected);
    if (is_whole && packet->expected.status != OK)
        throw Broken("the writer and the judge of this fuzzer disagree", number, name_of(OK),
                     name_of(packet->expected.status) + std::string(" of ") + hex(packet->bytes));
    const size_t bus = circuit_.bus_bytes;
    const size_t beats = std::max<size_t>(1, (packet->bytes.size() + bus - 1) / bus);
    packet->beats = static_cast<uint32_t>(beats);
    counts.bad += packet->expected.status != OK;
    ++counts.packets;
    sent_.push_back(std::move(packet));
}

void Bench::reset(Random& random, bool is_start) {
    const uint64_t before = checker_->oldest();
    const uint64_t lost = checker_->reset();
    // The packet that is being sent will be sent again, from its first beat.
    const bool is_begun = is_offering_ || beat_;
    if (!is_start) {
        ++counts.resets;
        counts.discarded += lost - is_begun;
    }
    is_offering_ = false;
    beat_ = 0;
    std::fill(held_.begin(), held_.end(), 0);
    for (uint32_t left = 1 + random.below(3); left; --left) {
        // Whatever is offered in a reset is lost.
        const uint32_t word = random.word();
        *circuit_.control = word & (Circuit::VALID | Circuit::LAST);
        for (size_t n = 0; n < valid_.size(); ++n)
            circuit_.ready[n] = random.word();
        step();
        for (size_t n = 0; n < valid_.size(); ++n)
            if (circuit_.valid[n])
                throw Broken("a stream is valid after a reset", before, "nothing is valid",
                             hex(circuit_.valid, valid_.size()));
    }
    idle_ = waited_ = 0;
}

// Put the next beat on the input, or rubbish that is not valid.
void Bench::offer(Random& random) {
    const size_t bus = circuit_.bus_bytes;
    const size_t words = (bus + 3) / 4;
    for (size_t n = 0; n < words; ++n) circuit_.data[n] = random.word();
    for (size_t n = 0; n < (bus + 31) / 32; ++n) circuit_.keep[n] = random.word();
    if (circuit_.counts_lanes) *circuit_.keep %= static_cast<uint32_t>(bus) + 1;
    *circuit_.control = Circuit::RUN | (random.one_in(2) ? Circuit::LAST : 0);
    const bool may_send = next_ < sent_.size() && (beat_ || checker_->may_send());
    is_offering_ = may_send && stalls_.offers(random);
    if (!is_offering_) return;
    const Sent& packet = *sent_[next_];
    if (beat_ == 0) checker_->sent(sent_[next_]);
    const size_t first = beat_ * bus;
    const size_t valid = std::min(bus, packet.bytes.size() - first);
    for (size_t lane = 0; lane < valid; ++lane) {
        uint32_t& word = circuit_.data[lane / 4];
        const int shift = 8 * (lane % 4);
        const uint32_t byte = packet.bytes[first + lane];
        word = (word & ~(255u << shift)) | byte << shift;
    }
    const bool is_last = beat_ + 1 == packet.beats;
    *circuit_.control = Circuit::RUN | Circuit::VALID | (is_last ? Circuit::LAST : 0);
    // In other beats, `keep` stays rubbish, and in the last one what follows the first zero.
    if (!is_last) return;
    if (circuit_.counts_lanes) {
        *circuit_.keep = static_cast<uint32_t>(valid);
        return;
    }
    for (size_t lane = 0; lane <= valid && lane < bus; ++lane) {
        uint32_t& word = circuit_.keep[lane / 32];
        const uint32_t bit = 1u << lane % 32;
        word = lane < valid ? word | bit : word & ~bit;
    }
}

// Look at all outputs: rules of streams, and what has become valid.
void Bench::look() {
    const uint64_t oldest = checker_->oldest();
    for (size_t n = 0; n < valid_.size(); ++n) {
        valid_[n] = circuit_.valid[n];
        if (held_[n] & ~valid_[n])
            throw Broken("valid was withdrawn before a transfer", oldest, hex(&held_[n], 1),
                         hex(&valid_[n], 1));
        for (uint32_t bits = valid_[n]; bits; bits &= bits - 1) {
            const size_t output = 32 * n + static_cast<size_t>(__builtin_ctz(bits));
            const Output& port = circuit_.outputs[output];
            std::vector<uint32_t>& before = payloads_[output];
            if (!(held_[n] & bits & (0u - bits))) {
                checker_->offered(static_cast<int>(output), port.payload);
                before.assign(port.payload, port.payload + port.words);
            } else if (!std::equal(before.begin(), before.end(), port.payload)) {
                throw Broken("a payload changed before its transfer on " + port.name, oldest,
                             hex(before.data(), before.size()), hex(port.payload, port.words));
            }
        }
    }
    checker_->offered_all();
}

// A falling and a rising edge. No output may depend on an input before the rising edge.
void Bench::step() {
    const uint32_t accepts = *circuit_.accept;
    circuit_.set_clock(false);
    circuit_.evaluate();
    for (size_t n = 0; n < valid_.size(); ++n)
        if (held_[n] & ~circuit_.valid[n])
            throw Broken("valid depends on an input of the same cycle", checker_->oldest(),
                         hex(held_.data(), held_.size()), hex(circuit_.valid, valid_.size()));
    if (accepts != *circuit_.accept)
        throw Broken("ready of the input depends on an input of the same cycle", checker_->oldest(),
                     std::to_string(accepts), std::to_string(*circuit_.accept));
    circuit_.set_clock(true);
    circuit_.evaluate();
    ++counts.cycles;
}

void Bench::do_cycle(Random& random) {
    look();
    stalls_.take(random, valid_.data(), circuit_.ready);
    if (!is_offering_) offer(random);
    bool did_something = false, is_stalled = !is_offering_ && next_ < sent_.size();
    const bool is_taken = is_offering_ && *circuit_.accept;
    if (circuit_.drops && !*circuit_.accept)
        throw Broken("a gate that drops holds the link", checker_->oldest(), "ready", "not ready");
    for (size_t n = 0; n < valid_.size(); ++n) {
        const uint32_t taken = valid_[n] & circuit_.ready[n];
        held_[n] = valid_[n];
        is_stalled |= (valid_[n] & ~circuit_.ready[n]) != 0;
        did_something |= taken != 0;
        for (uint32_t bits = taken; bits; bits &= bits - 1) {
            const size_t output = 32 * n + static_cast<size_t>(__builtin_ctz(bits));
            checker_->taken(static_cast<int>(output), payloads_[output].data());
        }
    }
    step();
    for (size_t n = 0; n < valid_.size(); ++n) held_[n] &= ~circuit_.ready[n];
    if (is_taken) {
        did_something = true;
        const bool is_last = ++beat_ == sent_[next_]->beats;
        checker_->beat_taken(is_last);
        is_offering_ = false;
        if (is_last) beat_ = 0, ++next_;
    }
    if (!is_stalled) ++waited_;
    check_progress(did_something);
}

void Bench::check_progress(bool did_something) {
    idle_ = did_something ? 0 : idle_ + 1;
    if (checker_->is_done() || checker_->progress() != progress_) waited_ = 0;
    progress_ = checker_->progress();
    if (checker_->is_done() && next_ == sent_.size()) return;
    if (idle_ > MOST_IDLE)
        throw Broken("nothing has happened for long", checker_->oldest(), "a transfer",
                     std::to_string(idle_) + " cycles without any");
    if (waited_ > checker_->budget())
        throw Broken("no status in time", checker_->oldest(),
                     "at most " + std::to_string(checker_->budget()) + " cycles without stalls",
                     std::to_string(waited_) + " cycles");
}
