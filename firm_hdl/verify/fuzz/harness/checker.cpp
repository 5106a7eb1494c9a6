#include "checker.h"

#include <algorithm>

namespace {

constexpr uint64_t SLACK_CYCLES = 64;

std::string number(uint64_t value) { return std::to_string(value); }

// Outputs whose transfers are all known when a packet is sent.
class Streams : public Checker {
public:
    explicit Streams(size_t outputs) : queues_(outputs) {}

    void taken(int output, const uint32_t*) override {
        const Entry entry = queues_[output].front();
        queues_[output].pop_front();
        ++tally.transfers;
        if (output == status_) {
            ++tally.statuses[entry.sent->expected.status];
            ++tally.judged;
        }
        --open_[entry.sent->number - first_];
        while (!packets_.empty() && open_.front() == 0) {
            packets_.pop_front();
            open_.pop_front();
            ++first_;
        }
    }

    uint64_t reset() override {
        const uint64_t lost = queues_[status_].size();
        for (auto& queue : queues_) queue.clear();
        packets_.clear();
        open_.clear();
        return lost;
    }

    bool is_done() const override { return packets_.empty(); }

    uint64_t budget() const override {
        if (queues_[status_].empty()) return 2 * SLACK_CYCLES;
        const Sent& sent = *queues_[status_].front().sent;
        const size_t bytes = sent.bytes.size() + sent.expected.rewritten.size();
        return SLACK_CYCLES + 3 * (sent.beats + sent.expected.transfers.size()) + bytes;
    }

    uint64_t oldest() const override {
        return packets_.empty() ? 0 : packets_.front()->number;
    }

protected:
    struct Entry {
        const Sent* sent;
        uint64_t order;
        uint32_t flags;
        const uint32_t* data;
    };

    void begin(const SentPtr& packet) {
        if (packets_.empty()) first_ = packet->number;
        packets_.push_back(packet);
        open_.push_back(0);
    }

    void expect(int output, const Entry& entry) {
        queues_[output].push_back(entry);
        ++open_.back();
    }

    const Entry& next(int output, const std::string& name, const uint32_t* payload, int words) {
        if (queues_[output].empty())
            throw Broken("an extra transfer on " + name, packets_.empty() ? first_ : oldest(),
                         "nothing", hex(payload, words));
        return queues_[output].front();
    }

    int status_ = 0;
    std::vector<std::deque<Entry>> queues_;
    std::deque<SentPtr> packets_;
    // Transfers of each of these packets that have not come.
    std::deque<uint64_t> open_;
    uint64_t first_ = 0;
};

// A deserializer: each leaf's transfers, and the status, which become valid in wire order.
class DeserializerChecker : public Streams {
public:
    DeserializerChecker(const Circuit& circuit, const Table& table)
        : Streams(circuit.outputs.size()), circuit_(circuit), table_(table) {
        status_ = static_cast<int>(circuit.outputs.size()) - 1;
    }

    void sent(const SentPtr& packet) override {
        begin(packet);
        const Expected& expected = packet->expected;
        for (const Transfer& each : expected.transfers)
            expect(each.leaf,
                   {packet.get(), order_++, each.is_last, expected.words.data() + each.at});
        expect(status_, {packet.get(), order_++, 0, nullptr});
    }

    void offered(int output, const uint32_t* payload) override {
        const Output& port = circuit_.outputs[output];
        const Entry& entry = next(output, port.name, payload, port.words);
        const uint32_t status = static_cast<uint32_t>(entry.sent->expected.status);
        const uint32_t* data = output == status_ ? &status : entry.data;
        const size_t words = output == status_ ? 1 : table_.leaves[output].words();
        if (payload[0] != entry.flags || !std::equal(data, data + words, payload + 1)) {
            const bool is_status = output == status_;
            throw Broken("a wrong value on " + port.name, entry.sent->number,
                         is_status ? name_of(status) : text(data, words, entry.flags),
                         is_status ? name_of(payload[1]) : text(payload + 1, words, payload[0]));
        }
        ++offered_;
        last_ = std::max(last_, entry.order);
    }

    void offered_all() override {
        if (offered_ && offered_ != last_ + 1)
            throw Broken("leaves do not become valid in wire order", oldest(),
                         "transfer " + number(offered_ - 1), "transfer " + number(last_));
    }

    uint64_t reset() override {
        order_ = offered_ = last_ = 0;
        return Streams::reset();
    }

private:
    static std::string text(const uint32_t* data, size_t words, uint32_t flags) {
        return hex(data, words) + (flags ? " last" : "");
    }

    const Circuit& circuit_;
    const Table& table_;
    uint64_t order_ = 0;    // of the next transfer that is expected
    uint64_t offered_ = 0;  // transfers that became valid
    uint64_t last_ = 0;     // the last one of these in wire order
};

// A deserializer whose leaves go into a serializer: packets come back.
class LoopChecker : public Streams {
public:
    explicit LoopChecker(const Circuit& circuit) : Streams(circuit.outputs.size()), circuit_(circuit) {
        status_ = DESERIALIZER_STATUS;
    }

    void sent(const SentPtr& packet) override {
        begin(packet);
        const size_t bus = circuit_.bus_bytes;
        const size_t beats =
            std::max<size_t>(1, (packet->expected.rewritten.size() + bus - 1) / bus);
        for (size_t beat = 0; beat < beats; ++beat)
            expect(PACKETS, {packet.get(), beat, beat + 1 == beats, nullptr});
        expect(DESERIALIZER_STATUS, {packet.get(), 0, 0, nullptr});
        expect(SERIALIZER_STATUS, {packet.get(), 0, 0, nullptr});
    }

    void offered(int output, const uint32_t* payload) override {
        const Output& port = circuit_.outputs[output];
        const Entry& entry = next(output, port.name, payload, port.words);
        if (output == PACKETS) return beat(entry, payload);
        const int status = output == DESERIALIZER_STATUS ? entry.sent->expected.status : OK;
        if (payload[1] != static_cast<uint32_t>(status))
            throw Broken("a wrong value on " + port.name, entry.sent->number, name_of(status),
                         name_of(payload[1]));
    }

private:
    enum { PACKETS, DESERIALIZER_STATUS, SERIALIZER_STATUS };

    // Flags are `tlast` and `tuser`; data and `tkeep` follow. Lanes that are not valid may be anything.
    void beat(const Entry& entry, const uint32_t* payload) const {
        const Bytes& bytes = entry.sent->expected.rewritten;
        const size_t bus = circuit_.bus_bytes;
        const size_t first = entry.order * bus;
        const size_t valid = std::min(bus, bytes.size() - first);
        const uint32_t* keep = payload + 1 + (bus + 3) / 4;
        bool is_right = payload[0] == entry.flags;
        for (size_t lane = 0; lane < bus; ++lane) {
            is_right &= (keep[lane / 32] >> lane % 32 & 1) == (lane < valid);
            if (lane < valid)
                is_right &= (payload[1 + lane / 4] >> 8 * (lane % 4) & 255) == bytes[first + lane];
        }
        if (is_right) return;
        const auto from = bytes.begin() + static_cast<long>(first);
        throw Broken("a wrong beat " + number(entry.order) + " on packets_out", entry.sent->number,
                     hex(Bytes(from, from + static_cast<long>(valid))) + " flags " + number(entry.flags),
                     hex(payload, circuit_.outputs[PACKETS].words) + " (words: flags, data, keep)");
    }

    const Circuit& circuit_;
};

// A gate: good packets leave, whole and in order; each packet has a status, and is counted.
class GateChecker : public Checker {
public:
    explicit GateChecker(const Circuit& circuit) : circuit_(circuit) {}

    void sent(const SentPtr& packet) override {
        unjudged_.push_back(packet);
        last_sent_ = packet->number;
    }

    void beat_taken(bool is_last) override {
        ++beats_in_;
        packets_in_ += is_last;
        note_peaks();
    }

    void offered(int output, const uint32_t* payload) override {
        if (output == PACKETS) {
            if (leaving_.empty() && beats_left_ == 0 && packets_left_ >= packets_in_)
                throw Broken("a packet leaves before it has come", last_sent_, "nothing", "a beat");
            return;
        }
        if (unjudged_.empty())
            throw Broken("an extra transfer on status", last_sent_, "nothing", name_of(payload[1]));
        const Sent& sent = *unjudged_.front();
        if (!is_allowed(sent, static_cast<int>(payload[1])))
            throw Broken("a wrong value on status", sent.number, name_of(judged(sent)),
                         name_of(payload[1]));
    }

    void taken(int output, const uint32_t* payload) override {
        ++tally.transfers;
        if (output == PACKETS) return beat(payload);
        const SentPtr sent = unjudged_.front();
        unjudged_.pop_front();
        const int status = static_cast<int>(payload[1]);
        ++tally.statuses[status];
        ++tally.judged;
        ++since_reset_[status];
        if (status == OK) {
            kept_.push_back(sent);
            match();
        } else {
            beats_gone_ += sent->beats;
            ++packets_gone_;
        }
        forget_peaks();
    }

    uint64_t reset() override {
        const uint64_t lost = unjudged_.size();
        unjudged_.clear();
        kept_.clear();
        left_.clear();
        leaving_.clear();
        since_reset_.fill(0);
        beats_in_ = packets_in_ = beats_gone_ = packets_gone_ = packets_left_ = 0;
        beats_left_ = beats_out_ = 0;
        forget_peaks();
        return lost;
    }

    bool is_done() const override { return unjudged_.empty() && kept_.empty() && left_.empty(); }

    uint64_t budget() const override {
        const uint64_t inside = 2 * circuit_.memory_bytes / circuit_.bus_bytes;
        if (unjudged_.empty()) return SLACK_CYCLES + inside;
        const Sent& sent = *unjudged_.front();
        // What lengths claim does not count. Packets before it may have to leave first.
        const uint64_t steps = sent.expected.good;
        return 4 * SLACK_CYCLES + 2 * (sent.beats + steps) + inside;
    }

    uint64_t oldest() const override {
        if (!kept_.empty()) return kept_.front()->number;
        return unjudged_.empty() ? last_sent_ : unjudged_.front()->number;
    }

    void at_end() override {
        static constexpr int ORDER[] = {OK, TRUNCATED, TRAILING, LENGTH, ENCAPSULATION,
                                        STRING, FULL, LARGE, OVERRUN};
        for (int n = 0; n < 9; ++n)
            if (circuit_.counters[n] != since_reset_[ORDER[n]])
                throw Broken(std::string("a wrong counter of ") + name_of(ORDER[n]), last_sent_,
                             number(since_reset_[ORDER[n]]), number(circuit_.counters[n]));
    }

    // More than 255 packets may be dropped without a status.
    bool may_send() const override { return !circuit_.drops || unjudged_.size() < MOST_UNJUDGED; }

private:
    enum { PACKETS, STATUS };
    static constexpr size_t MOST_UNJUDGED = 150;
    static constexpr uint64_t STATUSES = 8;
    static constexpr uint64_t BACKLOG = 200;

    struct Left {
        Bytes bytes;
        uint64_t size;
    };

    int judged(const Sent& sent) const {
        const bool is_large = sent.bytes.size() > circuit_.memory_bytes;
        return sent.expected.status == OK && is_large ? LARGE : sent.expected.status;
    }

    // A gate that drops may have no room: only if that many beats or statuses could be inside.
    bool is_allowed(const Sent& sent, int status) const {
        if (status == judged(sent)) return true;
        if (!circuit_.drops) return false;
        const uint64_t memory_beats = circuit_.memory_bytes / circuit_.bus_bytes;
        if (status == FULL && sent.expected.status == OK)
            return peak_beats_ + 1 >= memory_beats || peak_packets_ >= circuit_.memory_packets;
        return status == OVERRUN && (peak_waiting_ >= BACKLOG || peak_unjudged_ >= STATUSES);
    }

    void note_peaks() {
        uint64_t beats = 0;
        for (const SentPtr& each : unjudged_) beats += each->beats;
        peak_waiting_ = std::max(peak_waiting_, beats);
        peak_unjudged_ = std::max<uint64_t>(peak_unjudged_, unjudged_.size());
        peak_beats_ = std::max(peak_beats_, beats_in_ - beats_out_ - beats_gone_);
        peak_packets_ = std::max(peak_packets_, packets_in_ - packets_left_ - packets_gone_);
    }

    // Peaks count while anything is inside.
    void forget_peaks() {
        if (!is_done() || beats_in_ != beats_out_ + beats_gone_) return;
        peak_beats_ = peak_packets_ = peak_waiting_ = peak_unjudged_ = 0;
    }

    // Flags are `last`; data, count and size follow.
    void beat(const uint32_t* payload) {
        const int bus = circuit_.bus_bytes;
        const bool is_last = payload[0];
        const uint32_t count = payload[1 + (bus + 3) / 4];
        const uint32_t size = payload[2 + (bus + 3) / 4];
        if (beats_left_ == 0) size_ = size;
        if (size != size_ || (!is_last && count != static_cast<uint32_t>(bus)))
            throw Broken("a wrong size or count on packets_out", oldest(),
                         "size " + number(size_) + ", full beats",
                         "size " + number(size) + ", count " + number(count));
        for (uint32_t lane = 0; lane < count; ++lane)
            leaving_.push_back(static_cast<uint8_t>(payload[1 + lane / 4] >> 8 * (lane % 4)));
        ++beats_left_;
        ++beats_out_;
        if (!is_last) return;
        left_.push_back({std::move(leaving_), size});
        leaving_.clear();
        beats_left_ = 0;
        ++packets_left_;
        match();
        forget_peaks();
    }

    void match() {
        while (!kept_.empty() && !left_.empty()) {
            const Sent& sent = *kept_.front();
            if (left_.front().bytes != sent.bytes || left_.front().size != sent.bytes.size())
                throw Broken("a wrong packet on packets_out", sent.number, hex(sent.bytes),
                             hex(left_.front().bytes) + ", size " + number(left_.front().size));
            kept_.pop_front();
            left_.pop_front();
        }
    }

    const Circuit& circuit_;
    std::deque<SentPtr> unjudged_;  // without a status
    std::deque<SentPtr> kept_;      // with the status OK, and not left
    std::deque<Left> left_;         // left, and without a status
    Bytes leaving_;
    uint64_t size_ = 0;
    uint64_t last_sent_ = 0;
    std::array<uint64_t, OVERRUN + 1> since_reset_{};
    uint64_t beats_in_ = 0, packets_in_ = 0, beats_gone_ = 0, packets_gone_ = 0;
    uint64_t beats_left_ = 0, packets_left_ = 0, beats_out_ = 0;
    uint64_t peak_beats_ = 0, peak_packets_ = 0, peak_waiting_ = 0, peak_unjudged_ = 0;
};

}  // namespace

std::unique_ptr<Checker> make_checker(const Circuit& circuit, const Table& table) {
    switch (circuit.kind) {
        case CircuitKind::Deserializer:
            return std::make_unique<DeserializerChecker>(circuit, table);
        case CircuitKind::Loop:
            return std::make_unique<LoopChecker>(circuit);
        default:
            return std::make_unique<GateChecker>(circuit);
    }
}

std::string hex(const uint32_t* words, size_t count) {
    static const char DIGITS[] = "0123456789abcdef";
    std::string text = "0x";
    for (size_t n = count; n-- > 0;)
        for (int shift = 28; shift >= 0; shift -= 4) text += DIGITS[words[n] >> shift & 15];
    return text;
}

std::string hex(const Bytes& bytes) {
    static const char DIGITS[] = "0123456789abcdef";
    std::string text;
    for (uint8_t each : bytes) text += {DIGITS[each >> 4], DIGITS[each & 15]};
    return text.empty() ? "(empty)" : text;
}
