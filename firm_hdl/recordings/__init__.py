"""Recordings of ROS: topics, definitions as they were recorded, and messages as bytes.

Recordings come from anywhere, and may be damaged or made to harm. So the files are read here, and
not by rosbags, which decompresses without a limit, and refuses a recording because of any topic.
This package does not know what a definition means.
"""

from firm_hdl.recordings.limits import MAX_TEXT_BYTES, MAX_TOPICS
from firm_hdl.recordings.recording import Recording
from firm_hdl.recordings.topics import Schema, Topic

__all__ = ["MAX_TEXT_BYTES", "MAX_TOPICS", "Recording", "Schema", "Topic"]
