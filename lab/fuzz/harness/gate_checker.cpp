#include "checker.h"

#include <algorithm>

namespace {

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

std::unique_ptr<Checker> make_gate_checker(const Circuit& circuit) {
    return std::make_unique<GateChecker>(circuit);
}
