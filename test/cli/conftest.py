"""A bag as drivers write it that send no names."""

import pytest

from tendon_ros.bags.bag_writer import BagWriter
from tendon_ros.bags.messages import decode, encode
from tendon_ros.bags.storage import messages, open_bag
from tendon_ros.bags.topics import JOINT_STATE


@pytest.fixture
def nameless(tmp_path):
    """Return a function that copies a bag without the names of the joints."""

    def copy(path):
        out = tmp_path / f'{path.name}_nameless'
        with open_bag(path) as reader, BagWriter(out) as bag:
            types = {c.topic: c.msgtype for c in reader.connections}
            for topic, stamp, cdr in messages(path, reader, reader.connections):
                bag.add_topic(topic, types[topic])
                if types[topic] == JOINT_STATE:
                    message = decode(cdr, JOINT_STATE)
                    message.name = []
                    cdr = encode(message, JOINT_STATE)
                bag.write_raw(topic, cdr, stamp)
        return out

    return copy
