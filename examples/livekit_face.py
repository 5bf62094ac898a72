"""A LiveKit agent with a face: its speech becomes an avatar's picture and sound in the room.

``python examples/livekit_face.py dev``, with LIVEKIT_URL, LIVEKIT_API_KEY and LIVEKIT_API_SECRET of your server, and
the models of your choice in ``AgentSession``. Needs the extra livekit.
"""

from __future__ import annotations

from livekit import agents
from livekit.agents import Agent, AgentSession, JobContext
from livekit.agents.voice.avatar import AvatarRunner, QueueAudioOutput

from agentface import Face
from agentface.agents import Drawing, Speaker
from agentface.agents.livekit import FaceVideoGenerator


async def entrypoint(job: JobContext) -> None:
    """Join a room with a face."""
    await job.connect()
    face = Face(liveliness=0.6)
    generator = FaceVideoGenerator(Speaker(face, Drawing((640, 640)), rate_hz=24_000))
    sound = QueueAudioOutput(sample_rate=24_000)
    runner = AvatarRunner(job.room, audio_recv=sound, video_gen=generator, options=generator.options)

    async def end() -> None:
        await runner.aclose()
        await generator.aclose()
        face.close()

    job.add_shutdown_callback(end)
    session: AgentSession = AgentSession()  # stt=..., llm=..., tts=...: the models that you use
    session.output.audio = sound
    await runner.start()
    await session.start(agent=Agent(instructions="You are Amber, and people see your face."), room=job.room)


if __name__ == "__main__":
    agents.cli.run_app(agents.WorkerOptions(entrypoint_fnc=entrypoint))
